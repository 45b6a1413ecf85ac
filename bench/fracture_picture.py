"""The picture of bench/fracture: for each body its outline with the paths on all lattices, and the loads of growth over the theory."""

PANEL, GAP, TEXT = 220, 18, 13            # of a panel, px
INK, PALE = "#222222", "#9aa4ad"
COLOURS = ["#0b62a4", "#e07a1f", "#2f8f4e", "#c0392b", "#7d4fb0", "#8c6239", "#d2589b", "#5f6b73", "#b0a11e", "#1aa6b7"]


class Drawing:
    """Lines of an SVG file."""

    def __init__(self, width, height):
        self.lines = ['<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d" viewBox="0 0 %d %d" font-family="sans-serif" font-size="%d">'
                      % (width, height, width, height, TEXT), '<rect width="100%" height="100%" fill="white"/>']

    def path(self, points, colour, width=1.0, fill="none", closed=False):
        self.lines.append('<path d="M%s%s" fill="%s" stroke="%s" stroke-width="%g" stroke-linejoin="round"/>' % (
            " L".join("%.2f,%.2f" % p for p in points), " Z" if closed else "", fill, colour, width))

    def dot(self, x, y, colour):
        self.lines.append('<circle cx="%.2f" cy="%.2f" r="1.8" fill="%s"/>' % (x, y, colour))

    def word(self, x, y, text, anchor="start", size=TEXT, colour=INK):
        self.lines.append('<text x="%.1f" y="%.1f" text-anchor="%s" font-size="%d" fill="%s">%s</text>' % (x, y, anchor, size, colour, text))

    def write(self, path):
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(self.lines + ["</svg>", ""]))


def body_panel(d, x, y, body, runs):
    """The body in its own axes, with its cracks and the paths of all runs."""
    xs, ys = [v[0] for v in body.outline], [v[1] for v in body.outline]
    scale = min(PANEL / (max(xs) - min(xs)), PANEL / (max(ys) - min(ys)))
    x0, y0 = x + (PANEL - scale * (max(xs) - min(xs))) / 2, y + (PANEL - scale * (max(ys) - min(ys))) / 2

    def at(p):
        return (x0 + scale * (p[0] - min(xs)), y0 + scale * (max(ys) - p[1]))
    d.path([at(v) for v in body.outline], PALE, 1.2, "#f3f5f7", True)
    for a, b in body.cracks:
        inside = [(min(max(p[0], min(xs)), max(xs)), min(max(p[1], min(ys)), max(ys))) for p in (a, b)]
        d.path([at(p) for p in inside], INK, 2.2)
    for k, run in enumerate(runs):
        for path in run.paths:
            # from the crack as it is drawn: in other runs it is shifted by parts of a spacing
            tips = [t for crack in body.cracks for t in crack] or [path[0]]
            tip = min(tips, key=lambda t: (t[0] - path[0][0]) ** 2 + (t[1] - path[0][1]) ** 2)
            d.path([at((p[0] - path[0][0] + tip[0], p[1] - path[0][1] + tip[1])) for p in path], COLOURS[k % len(COLOURS)], 1.2)


def load_panel(d, x, y, body, runs):
    """Load over theory of every event, 0.9 to 1.1, along the growth."""
    low, high = 0.9, 1.1
    d.path([(x, y), (x + PANEL, y), (x + PANEL, y + PANEL), (x, y + PANEL)], PALE, 1, "none", True)
    for value in (0.95, 1.0, 1.05):
        at = y + PANEL * (high - value) / (high - low)
        d.path([(x, at), (x + PANEL, at)], PALE if value != 1 else INK, 0.6)
        d.word(x - 4, at + 4, "%.2f" % value, "end", 11)
    for k, run in enumerate(runs):
        for a, ratio in run.loads:
            if ratio == ratio:
                share = (a - body.start) / max(body.growth, 1e-9)
                d.dot(x + PANEL * min(share, 1), y + PANEL * (high - min(max(ratio, low), high)) / (high - low), COLOURS[k % len(COLOURS)])


def picture(path, bodies):
    """bodies: (body, runs on its lattices)."""
    columns = 3
    wide, tall = 2 * PANEL + 3 * GAP + 30, PANEL + 3 * GAP
    rows = (len(bodies) + columns - 1) // columns
    d = Drawing(columns * wide + GAP, rows * tall + 2 * GAP)
    for k, (body, runs) in enumerate(bodies):
        x, y = GAP + (k % columns) * wide, GAP + (k // columns) * tall
        d.word(x, y + TEXT, body.title)
        body_panel(d, x, y + GAP + 4, body, runs)
        load_panel(d, x + PANEL + GAP + 30, y + GAP + 4, body, runs)
    d.word(GAP, rows * tall + GAP + 8, "Left: paths on all lattices, drawn in the axes of the body. Right: load factor of each event over theory along the growth.", size=12)
    d.write(path)
