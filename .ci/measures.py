"""How much of a maze the tree is: numbers that .ci/lint prints as "now / then". Each function below says how it counts."""
import collections, glob, os, random, re, subprocess

OBJECTS = 'build/release/'
FORCE = 'pg_force_type'                              # the interface that all mechanics are reached by
MECHANICS = ('mechanics', 'discretization')          # rooms that may ask whether there are shape functions
RANKS = {'ranks', 'app/mpi'}                             # folders that may know of several processes
# Where the tree is to arrive. Measures without a limit are there to be watched.
THEN = {
    'call cycle': 10, 'upward links': 0, 'entries of a force': 20, '... with extensions': 34, 'other interface': None,
    'fields many write': 30, 'shape_functions': 0, 'files that know ranks': 20, 'largest folder': 30, 'top folders': 12,
    'lines': 110000, 'tokens': 1136000, 'tokens a line': None, 'comments that lean': 0,
}


# ---- links between files ---------------------------------------------------------------------------------------------
def links(tree):
    """(calls, all): file -> file it uses -> names of functions, or of functions and tables. By `nm` of the object files; a name that
    several files define, as main, links none. None instead, and why, where an object is missing or older than its source."""
    files = [s.path[4:-2] for s in tree.library if s.path.endswith('.c')]
    age = {f: os.path.getmtime(f'{OBJECTS}src/{f}.o') if os.path.exists(f'{OBJECTS}src/{f}.o') else 0 for f in files}
    lost = [f for f in files if age[f] < os.path.getmtime(f'src/{f}.c') and (age[f] or os.path.dirname(f) in tree.order)]
    if lost:
        return None, f'objects of {OBJECTS}src that are missing or older than their source: {len(lost)}, as {lost[0]}.o; make first'
    there = [f for f in files if age[f]]             # programs beside the library are compiled where their libraries are installed
    output = subprocess.run([os.environ.get('NM', 'nm'), '-A', '-P', '-g'] + [f'{OBJECTS}src/{f}.o' for f in there],
                            capture_output=True, text=True, check=True).stdout
    defined, used = collections.defaultdict(list), []
    for path, name, kind in re.findall(r'^(\S+)\.o: (\S+) (\w)', output, re.M):
        path = path[len(OBJECTS) + 4:]
        if kind in 'Uwv':
            used.append((path, name))
        else:
            defined[name].append((path, kind))
    calls, every = {f: {} for f in there}, {f: {} for f in there}
    for path, name in used:
        for other, kind in defined[name] if len(defined[name]) == 1 else []:
            for graph in (every, calls) if kind in 'TW' else (every,):
                graph[path].setdefault(other, []).append(name)
    return (calls, every), ''


def cycle(graph):
    """The largest set of files each of which reaches each other one along the links."""
    files = sorted(graph)
    place = {f: k for k, f in enumerate(files)}
    reach = [sum(1 << place[g] for g in graph[f]) for f in files]         # a bit for each file that is reached
    for k in range(len(files)):
        for i in range(len(files)):
            if reach[i] >> k & 1:
                reach[i] |= reach[k]
    sets = [[g for j, g in enumerate(files) if reach[i] >> j & 1 and reach[j] >> i & 1] for i in range(len(files))]
    return max(sets, key=len, default=[])


def measure_links(tree):
    graphs, why_not = links(tree)
    calls, every = graphs or ({}, {})
    largest, last = cycle(calls), len(tree.order)
    yield ('call cycle', len(largest) if graphs else None,
           why_not or f'files that all call each other by some way; {len(cycle(every))} by functions and tables', largest)
    upward = [(f, g) for f in sorted(every) for g in sorted(every[f])
              if tree.rank.get(os.path.dirname(f), last) < tree.rank.get(os.path.dirname(g), last)]
    yield ('upward links', len(upward) if graphs else None,
           why_not or f'pairs of files, the second in a later folder; {sum(g in calls[f] for f, g in upward)} by functions',
           [f'{f}.c uses {", ".join(sorted(set(every[f][g])))} of {g}.c' for f, g in upward])


# ---- structs ---------------------------------------------------------------------------------------------------------
STRUCT = re.compile(r'\b(typedef\s+)?struct\s*(\w*)\s*\{((?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*)\}\s*(?:\w+\s+)*(\w*)')


class Struct:
    """A struct and its fields: name -> (type, whether it is a function pointer, whether it is const). Structs and unions that are written
    out within it lend it their fields; one of another type that it holds is one field."""

    def __init__(self, name, path, body, function_types):
        self.name, self.path, self.fields, self.width, inner = name, path, {}, 0, 1
        body = re.sub(r'\benum\s*\w*\s*\{[^{}]*\}', 'int', body)
        while inner:
            body, inner = re.subn(r'\b(?:struct|union)\s*\w*\s*\{([^{}]*)\}[^;]*;', r'\1', body)
        for declaration in body.split(';'):
            pointer = re.search(r'\(\s*\*+\s*(?:const\s+)?(\w+)\s*(?:\[[^\]]*\]\s*)?\)\s*([(\[])', declaration)
            kind = re.match(r'\s*(?:(?:const|struct|union|volatile)\s+)*(\w+)', declaration)
            names = re.sub(r'\[[^;]*?\]|:\s*\d+', '', declaration[kind.end():]) if kind and not pointer else ''
            for name in re.findall(r'(\w+)\s*(?:,|$)', names):
                self.fields[name] = (kind.group(1), kind.group(1) in function_types, 'const' in declaration)
                self.width += 1
            if pointer:
                self.fields[pointer.group(1)] = ('', pointer.group(2) == '(', False)
                self.width += 1
        self.functions = sum(function for _, function, _ in self.fields.values())


def structs_of(tree):
    """Name -> the structs of that name: a file's own one, its folder's and that of include may differ."""
    found = collections.defaultdict(list)
    texts = [(s.path, '\n'.join(line for line in s.code if not line.lstrip().startswith('#'))) for s in tree.library + tree.headers]
    function_types = {name for _, text in texts for name in re.findall(r'typedef[^;{}]*\(\s*\*\s*(\w+)\s*\)\s*\(', text)}
    for path, text in texts:
        for typedef, tag, body, name in STRUCT.findall(text):
            name = name if typedef else tag
            if name:
                found[name].append(Struct(name, path, body, function_types))
    return found


def struct_seen(found, name, source):
    """The struct that a name means in a file."""
    for place in (source.path, os.path.dirname(source.path) + '/', 'include/', 'src/'):
        for struct in found.get(name, ()):
            if struct.path == source.path or struct.path.startswith(place) and struct.path.endswith('.h'):
                return struct
    return None


def measure_interfaces(tree, found):
    """Interfaces: structs with function pointers of which there is a constant table, or one that such a table holds. A member
    counts as one entry, a function or not; structs with functions of the same header that it holds are its extensions, whose entries
    count as well."""
    code = '\n'.join(line for s in tree.library for line in s.code)
    tables = set(re.findall(r'\bconst\s+(\w+)\s+\w+\s*(?:\[[^\]]*\]\s*)?=', code))
    tables |= {kind for name in tables for s in found.get(name, ()) for kind, _, _ in s.fields.values()}
    widths = {}
    for struct in (s for same in found.values() for s in same if s.functions):
        beside = {s.name: s for same in found.values() for s in same if s.path == struct.path and s is not struct and s.functions}
        inner = [beside[kind] for kind, function, _ in struct.fields.values() if kind in beside and not function]
        width = struct.width - len(inner)
        widths[struct.name] = (width, width + sum(s.width for s in inner), struct.path)
    width, whole, path = widths.get(FORCE, (None, None, ''))
    yield 'entries of a force', width, f'members of {FORCE}, functions or not' if width else f'no struct {FORCE}', []
    yield '... with extensions', whole, 'and those of the structs of entries that it holds', []
    rest = sorted(((w, name, path) for name, (w, _, path) in widths.items() if name in tables and name != FORCE), reverse=True)
    yield ('other interface', rest[0][0] if rest else 0, f'the widest: {rest[0][1]}' if rest else '',
           [f'{name} has {w} entries ({path})' for w, name, path in rest])


INDEX = r'\[[^\[\]]*(?:\[[^\[\]]*\][^\[\]]*)*\]'
CHAIN = re.compile(rf'\b([A-Za-z_]\w*)(?:\s*{INDEX})*((?:(?:->|\.)[A-Za-z_]\w*(?:\s*{INDEX})*)+)'
                   r'\s*(\+\+|--|(?:<<|>>|[-+*/%&|^])?=(?!=))?')
DECLARED = re.compile(r'\b(const\s+)?([A-Za-z_]\w*)\s+\**(?:const\s+)?([A-Za-z_]\w*)\s*(?=[,;=)\[])')
STATEMENTS = {'return', 'else', 'goto', 'case', 'sizeof', 'const', 'struct'}


def declared(text, found):
    """Name of a variable -> (its type, where that is a struct; whether it is const), by its last declaration in a function;
    of variables that are declared together the first alone."""
    return {name: (kind if kind in found else None, bool(constant))
            for constant, kind, name in DECLARED.findall(text) if kind not in STATEMENTS}


def field_meant(source, found, kind, constant, chain):
    """(struct, field, whether it is reached through const) of what `->a[i].b` means behind a variable; struct None: not known."""
    owner, field, fixed = None, None, False
    for step in re.findall(r'(?:->|\.)(\w+)', re.sub(INDEX, '', chain)):
        struct = struct_seen(found, kind, source)
        if struct and step in struct.fields:
            owner, field, fixed = struct, step, fixed or constant
            kind, _, constant = struct.fields[step]
        else:
            owner = None                             # the name of a struct that is written out: its fields are those of the outer one
    return owner, field, fixed


def fields_written(source, found):
    """(struct, field) that a file writes: x.f = or x->f =, also += and the like, ++, --, elements f[i] =, and &x->f that a call is given
    (unless x points to const). x has the type of its declaration in the same function; casts, macros and calls are not looked through."""
    for text in re.split(r'^\}', '\n'.join(source.code), flags=re.M):
        types = declared(text, found)
        for match in CHAIN.finditer(text):
            kind, constant = types.get(match.group(1), (None, False))
            before = re.search(r'(\+\+|--|[(,]\s*&)\s*$', text[max(0, match.start() - 4):match.start()])
            if kind and (before or match.group(3)):
                owner, field, fixed = field_meant(source, found, kind, constant, match.group(2))
                if owner and (match.group(3) or '&' not in before.group(1) or not fixed):
                    yield owner, field


def measure_writers(tree, found):
    writers = collections.defaultdict(set)
    for source in tree.library:
        for struct, field in fields_written(source, found):
            writers[struct].add(source.path)
    many = sorted(((s.width, len(paths), s.name, s.path) for s, paths in writers.items() if len(paths) > 1), reverse=True)
    yield ('fields many write', many[0][0] if many else 0, f'those of {many[0][2]}, which {many[0][1]} files write' if many else '',
           [f'{name} has {n} fields, {files} files write them ({path})' for n, files, name, path in many[:10]])


# ---- files and text --------------------------------------------------------------------------------------------------
def measure_files(tree):
    codes = [(s.path, s.folder, '\n'.join(s.code)) for s in tree.library]
    asking = [p for p, folder, code in codes if not (folder or '').startswith(MECHANICS) and re.search(r'\bshape_functions\b', code)]
    yield 'shape_functions', len(asking), f'files that ask for it outside {", ".join(sorted(MECHANICS))}', asking
    knowing = [p for p, folder, code in codes if folder not in RANKS and re.search(r'\bpg_ranks?(?![a-z])|\bpg_owns|subdomain', code)]
    yield 'files that know ranks', len(knowing), 'outside ranks and mpi: pg_rank.., pg_ranks.., pg_owns, subdomain', knowing
    folders = collections.Counter(os.path.dirname(s.path) for s in tree.library)
    name, size = max(folders.items(), key=lambda item: item[1], default=('', 0))
    yield 'largest folder', size, f'files of {name}', [f'{name}: {size} files' for name, size in folders.most_common(10)]
    yield 'top folders', len(glob.glob('src/*/')), 'folders in src', []


TOKEN = re.compile(r'"[^"]*"|\'[^\']*\'|[A-Za-z_]\w*|\.?\d(?:[eEpP][+-]|[\w.])*|<<=|>>=|\.\.\.|->|\+\+|--|<<|>>|'
                   r'[<>=!+\-*/%&|^]=|&&|\|\||##|[^\s\\]')


def measure_text(tree):
    """Lines of src as `wc -l` counts them; tokens of C: a string is one, `->` is one."""
    tokens = sum(len(TOKEN.findall(line)) for s in tree.library for line in s.code)
    yield 'lines', sum(len(s.lines) - 1 for s in tree.library), 'of src, comments and empty ones too', []
    yield 'tokens', tokens, 'of src, without comments', []
    filled = sum(1 for s in tree.library for line in s.code if line.strip())
    yield 'tokens a line', round(tokens / max(1, filled), 1), f'of the {filled} lines with code', []


# Openings that say nothing without another comment; a few words that open with Of have no subject.
LEANS = re.compile(r'(?i:the same|as (?:that|those|above|before|there|here|it|the others?)|those|that (?:of|one|for|in|with)|also|'
                   r'likewise|ditto|so (?:is|are|has|have|do|does)|the others?|and|or|but|again|of (?:that|those|these|them))\b|Of(?: \S+){0,5}$')


def comments(tree):
    """(path, line, text, code) of every comment of src and include; code: what stands on its line, or on the next one with code."""
    for source in tree.library + tree.headers:
        for line, text in source.pieces('/'):
            codes = (code for code in source.code[line - 1:] if code.strip())
            yield source.path, line, re.sub(r'\s+', ' ', re.sub(r'^/[*/]|\*/$|\n\s*\*', ' ', text)).strip(), next(codes, '').strip()


def measure_comments(tree):
    leaning = [c for c in comments(tree) if LEANS.match(c[2])]
    yield ('comments that lean', len(leaning), 'open with "The same", "As that", "Those", "Also" and the like',
           [f'{path}:{line}: {text[:80]}' for path, line, text, code in leaning])


def draw_comments(tree, seed, number):
    """So many comments, drawn by a seed, each with its line, for a reader to judge."""
    every = sorted(comments(tree))
    for path, line, text, code in random.Random(seed).sample(every, min(number, len(every))):
        print(f'{path}:{line}: {text}\n    {code}')


def measures(tree):
    """(name, number or None, how it is counted, what --why lists) of every measure."""
    found = structs_of(tree)
    yield from measure_links(tree)
    yield from measure_interfaces(tree, found)
    yield from measure_writers(tree, found)
    yield from measure_files(tree)
    yield from measure_text(tree)
    yield from measure_comments(tree)
