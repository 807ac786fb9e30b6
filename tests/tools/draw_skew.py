#!/usr/bin/env python3
"""Draws the histograms of tests/bench/skew_bench as one SVG: grey without, blue with the optimiser; lines at 6 and 18 degrees.

usage: draw_skew.py HISTOGRAM_LINES > docs/skew.svg        HISTOGRAM_LINES: what skew_bench writes to standard error
"""
import html
import sys

COLUMNS, WIDTH, HEIGHT, GAP, SHOWN = 3, 300, 130, 34, 30  # bins of 2 degrees that are drawn


def bars(values, top, x, y, colour, inset):
    step = WIDTH / SHOWN
    return [f'<rect x="{x + i * step + inset:.1f}" y="{y + HEIGHT - HEIGHT * v / top:.1f}" width="{step - 2 * inset:.1f}" height="{HEIGHT * v / top:.1f}" fill="{colour}"/>'
            for i, v in enumerate(values[:SHOWN])]


def main():
    data = {}
    for line in open(sys.argv[1], encoding="utf-8"):
        words = line.split()
        if words and words[0] == "histogram":
            data.setdefault(words[1], {})[words[2]] = [float(w) for w in words[3:]]
    rows = -(-len(data) // COLUMNS)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{COLUMNS * (WIDTH + GAP) + GAP}" height="{rows * (HEIGHT + 2 * GAP) + GAP}" font-family="sans-serif" font-size="11">',
           '<rect width="100%" height="100%" fill="white"/>']
    for n, (name, kinds) in enumerate(data.items()):
        x, y = GAP + n % COLUMNS * (WIDTH + GAP), GAP + n // COLUMNS * (HEIGHT + 2 * GAP)
        top = max(max(v[:SHOWN]) for v in kinds.values())
        out += bars(kinds["none"], top, x, y, "#bbbbbb", 0.3) + bars(kinds["descent"], top, x, y, "#2b6cb0", 2.6)
        for limit in (6, 18):
            at = x + WIDTH * limit / (2 * SHOWN)
            out.append(f'<line x1="{at}" x2="{at}" y1="{y}" y2="{y + HEIGHT}" stroke="#c53030" stroke-dasharray="3 2"/><text x="{at + 2}" y="{y + 10}" fill="#c53030">{limit}</text>')
        out.append(f'<line x1="{x}" x2="{x + WIDTH}" y1="{y + HEIGHT}" y2="{y + HEIGHT}" stroke="black"/>')
        out += [f'<text x="{x + WIDTH * d / (2 * SHOWN)}" y="{y + HEIGHT + 13}" text-anchor="middle">{d}</text>' for d in (0, 20, 40, 60)]
        out.append(f'<text x="{x}" y="{y - 6}" font-weight="bold">{html.escape(name)}</text><text x="{x + WIDTH}" y="{y + 14}" text-anchor="end">highest bar {top:.1f} % of the prisms</text>')
    out.append("</svg>")
    print("\n".join(out))


if __name__ == "__main__":
    main()
