"""What bench/run and bench/accuracy share: tables in Markdown, and the pages of doc/ that they rewrite.

A page holds, for each group of measurements, a pair of comments

    <!-- measured: GROUP -->
    ...
    <!-- end -->

What stands between them is replaced: the command, the date and the version, and the tables. Everything else in the pages is
written by hand.
"""
import datetime
import math
import os
import re
import statistics
import subprocess
import sys
import time


class Failure(Exception):
    """A command failed, or printed something else than what is read here."""


class Skipped(Exception):
    """A tool lacks that the measurement needs."""


# ---- Markdown --------------------------------------------------------------------------------------------------------
def command(*lines):
    """An indented block; test/app/cli/test_doc_commands.sh runs or checks its lines."""
    return ["    " + line for line in lines] + [""]


def table(head, rows):
    return ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)] + ["| " + " | ".join(row) + " |" for row in rows] + [""]


def number(value, digits=2):
    """1.83e-3"""
    if value is None or not math.isfinite(value):
        return "-"
    mantissa, exponent = ("%.*e" % (digits, value)).split("e")
    return "%se%d" % (mantissa, int(exponent))


def short(value, digits=3):
    """Three significant digits without an exponent where that is readable."""
    if value is None or not math.isfinite(value):
        return "-"
    if value != 0 and (abs(value) >= 1e5 or abs(value) < 1e-4):
        return number(value, digits - 1)
    return "%.*f" % (max(0, digits - 1 - (math.floor(math.log10(abs(value))) if value else 0)), value)


def percent(value, digits=2):
    return "%+.*f %%" % (digits, 100 * value)


def spread(values, factor=1.0):
    """min, median, max"""
    values = [factor * v for v in values]
    if not values:
        return "-"
    return ", ".join(short(v) for v in (min(values), statistics.median(values), max(values)))


# ---- pages -----------------------------------------------------------------------------------------------------------
def commit():
    try:
        return subprocess.run(["git", "rev-parse", "--short", "HEAD"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            return re.search(r"^model name\s*: (.*)$", file.read(), re.M).group(1)
    except (OSError, AttributeError):
        return "unknown processor"


def write(pages, group, stamp, lines):
    """Replaces the block of the group in the pages that have one; how many had."""
    block = "<!-- measured: %s -->\n*%s*\n\n%s\n\n<!-- end -->" % (group, stamp, "\n".join(lines).rstrip())
    written = 0
    for page in pages:
        with open(page, encoding="utf-8") as file:
            text = file.read()
        changed, count = re.subn(r"<!-- measured: %s -->\n.*?<!-- end -->" % group, lambda _: block, text, flags=re.S)
        if count:
            with open(page + ".new", "w", encoding="utf-8") as file:
                file.write(changed)
            os.replace(page + ".new", page)
            written += count
    return written


def run_groups(target, pages, groups, chosen, measure, note=""):
    """Measures the groups chosen (all but the long ones), one after the other, and writes each when it is done. groups: name ->
    (function, long, one line); measure (function) calls it. Exit code: 1 if one failed."""
    failed = 0
    for group in chosen:
        if group not in groups:
            sys.exit("make %s: %s is none of: %s" % (target, group, " ".join(groups)))
    for group in chosen or [name for name, (_, long, _) in groups.items() if not long]:
        start = time.time()
        try:
            lines = measure(groups[group][0])
            version = commit()
            stamp = "`make %s T=%s`, %s%s%s, %.0f s" % (target, group, datetime.date.today(), ", commit " + version if version else "", note,
                                                       time.time() - start)
            if not write(pages, group, stamp, lines):
                raise Failure("no page has a place <!-- measured: %s -->" % group)
            print("%-16s %6.1f s" % (group, time.time() - start), flush=True)
        except Skipped as why:
            print("%-16s skipped: %s" % (group, why), flush=True)
        except (Failure, OSError, KeyError, ValueError) as fault:
            failed = 1
            print("%-16s FAILED: %s" % (group, fault), flush=True)
    return failed


def list_groups(groups):
    for name, (_, long, what) in groups.items():
        print("%-16s %s%s" % (name, what, " (long: only when named)" if long else ""))
