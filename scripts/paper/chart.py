"""Lines over a logarithmic axis, as SVG."""

import math

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 640, 400, 60, 170, 40, 50
COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000"]


def draw(path, title, x_label, y_label, lines):
    """`lines` is {name: {x: y}}; those whose name begins with "published" are dashed."""
    xs = sorted({x for line in lines.values() for x in line})
    top = 1.1 * max(y for line in lines.values() for y in line.values())

    def at(x, y):
        along = math.log(x / xs[0]) / math.log(xs[-1] / xs[0]) if len(xs) > 1 else 0.5
        return LEFT + along * (WIDTH - LEFT - RIGHT), HEIGHT - BOTTOM - y / top * (HEIGHT - TOP - BOTTOM)

    def text(x, y, words, anchor="middle", more=""):
        return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {more}>{words}</text>'

    parts = [text(WIDTH / 2, 22, title, more='font-size="15"'), text((WIDTH - RIGHT) / 2, HEIGHT - 10, x_label),
             text(16, HEIGHT / 2, y_label, more=f'transform="rotate(-90 16 {HEIGHT / 2})"')]
    for tick in range(6):
        x, y = at(xs[0], top * tick / 5)
        parts.append(f'<line x1="{x}" x2="{WIDTH - RIGHT}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/>')
        parts.append(text(x - 6, y + 4, f"{top * tick / 5:.3g}", "end"))
    labeled = -math.inf
    for x in xs:
        place = at(x, 0)[0]
        if place - labeled > 24:
            parts.append(text(place, HEIGHT - BOTTOM + 18, f"{x:g}"))
            labeled = place
    for number, (name, line) in enumerate(lines.items()):
        color = COLORS[number % len(COLORS)]
        dash = ' stroke-dasharray="5 4"' if name.startswith("published") else ""
        points = " ".join("{:.1f},{:.1f}".format(*at(x, line[x])) for x in sorted(line))
        parts.append(f'<polyline points="{points}" fill="none" stroke="{color}" stroke-width="2"{dash}/>')
        y = TOP + 20 * number
        parts.append(f'<line x1="{WIDTH - RIGHT + 10}" x2="{WIDTH - RIGHT + 34}" y1="{y}" y2="{y}" stroke="{color}" '
                     f'stroke-width="2"{dash}/>')
        parts.append(text(WIDTH - RIGHT + 40, y + 4, name, "start"))
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
                    f'font-size="11"><rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>{"".join(parts)}</svg>\n')
