"""A page of SVG: lines, arrows, bodies, ground and labels in one style.

Coordinates are those of the SVG: x to the right, y down, in pixels at the natural size.
"""

from html import escape
from math import atan2, ceil, cos, floor, hypot, pi, sin

SANS = "DejaVu Sans, Verdana, Arial, sans-serif"
SERIF = "STIX Two Text, Cambria, Times New Roman, DejaVu Serif, serif"

# What a colour of an arrow means is the same in all figures.
INK, GREY, PALE = "#222222", "#777777", "#bbbbbb"
MOTION, ACCELERATION, WRENCH, AXIS = "#1b6ca8", "#3a7d2c", "#b5541c", "#7a3e9d"
BODY, BODY_EDGE = "#e6ebf0", "#5b6770"
TINTS = {MOTION: "#d7e7f3", ACCELERATION: "#deeeda", WRENCH: "#f6e3d8", AXIS: "#eadff1"}

THIN, LINE, BOLD = 1.0, 1.5, 2.4
SMALL, NORMAL, SYMBOL, TITLE = 11, 12, 16, 14


def number(x):
    """A coordinate with two decimals; the last bit of x does not decide a tie."""
    text = f"{floor(x * 100 + 0.5 + 1e-6) / 100:.2f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def points(where):
    return " ".join(f"{number(x)},{number(y)}" for x, y in where)


def towards(a, b, length):
    """The point at a distance from a, in the direction of b."""
    far = hypot(b[0] - a[0], b[1] - a[1])
    return (a[0] + (b[0] - a[0]) * length / far, a[1] + (b[1] - a[1]) * length / far)


def between(a, b, t):
    return (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t)


def beside(a, b, offset):
    """The segment from a to b, moved to its left as seen on the page (offset > 0)."""
    far = hypot(b[0] - a[0], b[1] - a[1])
    dx, dy = (b[1] - a[1]) / far * offset, -(b[0] - a[0]) / far * offset
    return (a[0] + dx, a[1] + dy), (b[0] + dx, b[1] + dy)


def circle(centre, radius, start=0.0, end=2 * pi):
    """Points of an arc; angles from the x axis, counterclockwise as seen on the page."""
    count = max(2, ceil(abs(end - start) * 16))
    angles = (start + (end - start) * k / count for k in range(count + 1))
    return [(centre[0] + radius * cos(t), centre[1] - radius * sin(t)) for t in angles]


def bow(a, b, height, gap=0.0):
    """Points of a bow from a to b, `height` to the left of its chord, short of both ends by `gap`."""
    middle = between(*beside(a, b, 2 * height), 0.5)
    curve = []
    for k in range(41):
        t = k / 40
        curve.append(between(between(a, middle, t), between(middle, b, t), t))
    far = [p for p in curve if hypot(p[0] - a[0], p[1] - a[1]) >= gap]
    return [p for p in far if hypot(p[0] - b[0], p[1] - b[1]) >= gap]


def runs(markup):
    """Pieces (text, italic, level) of a symbol; level is -1 below, 1 above the line, 0 on it.

    `_` and `^` lower and raise the next character or the next group in braces. A single letter is
    italic; words such as Ad and sin are upright, unless they are lowered: there they are indices.
    Quotation marks about a piece make it upright.
    """
    marks = "\u0307\u0302"
    out, at = [], 0
    while at < len(markup):
        if markup[at] == '"':
            end = markup.index('"', at + 1)
            out.append((markup[at + 1 : end], False, 0))
            at = end + 1
            continue
        level = {"_": -1, "^": 1}.get(markup[at], 0)
        at += level != 0
        if level and markup[at] == "{":
            end = markup.index("}", at)
            text, at = markup[at + 1 : end], end + 1
        elif markup[at].isalpha():
            end = at + 1
            while end < len(markup) and (markup[end] in marks or not level and markup[end].isalpha()):
                end += 1
            text, at = markup[at:end], end
        else:
            text, at = markup[at], at + 1
        letters = "".join(c for c in text if c not in marks)
        italic = letters.isalpha() and (len(letters) == 1 or level < 0) and not (level > 0 and letters == "T")
        out.append((text, italic, level))
    return out


class Page:
    """A white panel of a width and a height in pixels; readable on light and on dark pages."""

    def __init__(self, width, height, title):
        self.out = [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
            f'viewBox="0 0 {width} {height}" role="img" font-family="{SANS}">',
            f"<title>{escape(title)}</title>",
            f'<rect x="0.5" y="0.5" width="{width - 1}" height="{height - 1}" rx="10" '
            f'fill="#ffffff" stroke="{PALE}"/>',
        ]

    def svg(self):
        return "\n".join([*self.out, "</svg>\n"])

    # ------------------------------------------------------------------------------------ lines

    def shape(self, tag, where, fill, colour, width, dash=None, opacity=None):
        extra = f' stroke-dasharray="{dash}"' if dash else ""
        extra += f' opacity="{opacity}"' if opacity else ""
        paint = f'stroke="{colour}" stroke-width="{number(width)}"' if colour else 'stroke="none"'
        self.out.append(
            f'<{tag} {where} fill="{fill}" {paint} stroke-linejoin="round" stroke-linecap="round"{extra}/>'
        )

    def line(self, where, colour=INK, width=LINE, dash=None, opacity=None):
        self.shape("polyline", f'points="{points(where)}"', "none", colour, width, dash, opacity)

    def polygon(self, where, fill, colour=None, width=LINE, dash=None, opacity=None):
        self.shape("polygon", f'points="{points(where)}"', fill, colour, width, dash, opacity)

    def disc(self, centre, radius, fill="#ffffff", colour=INK, width=LINE, dash=None, opacity=None):
        where = f'cx="{number(centre[0])}" cy="{number(centre[1])}" r="{number(radius)}"'
        self.shape("circle", where, fill, colour, width, dash, opacity)

    def arrow(self, where, colour=INK, width=BOLD, head=None, dash=None, both=False):
        """An arrow along the points; its tip is the last one (`both`: and the first one)."""
        where = list(where)
        head = head or 4 + 2.6 * width
        tips = []
        for _ in range(2 if both else 1):
            where, tip = self.shortened(where, head)
            tips.append(tip)
            where.reverse()
        if not both:
            where.reverse()
        self.line(where, colour, width, dash)
        for tip in tips:
            self.polygon(tip, colour)

    @staticmethod
    def shortened(where, head):
        """The line up to the root of the head at its end, and the head's triangle."""
        end, kept = where[-1], list(where)
        while len(kept) > 2 and hypot(kept[-2][0] - end[0], kept[-2][1] - end[1]) < head:
            kept.pop()
        root = towards(end, kept[-2], min(head, hypot(kept[-2][0] - end[0], kept[-2][1] - end[1])))
        across = beside(root, end, 0.36 * head)[0], beside(root, end, -0.36 * head)[0]
        return [*kept[:-1], towards(end, root, 0.8 * hypot(root[0] - end[0], root[1] - end[1]))], [end, *across]

    def turn(self, centre, radius, start, end, colour=INK, width=BOLD, both=False):
        """An arrow about a centre, from one angle to another, counterclockwise if end > start."""
        self.arrow(circle(centre, radius, start, end), colour, width, both=both)

    def out_of_page(self, centre, colour=AXIS, radius=6):
        self.disc(centre, radius, colour=colour)
        self.disc(centre, 1.8, colour, None)

    def right_angle(self, corner, a, b, size=8, colour=GREY):
        p, q = towards(corner, a, size), towards(corner, b, size)
        self.line([p, (p[0] + q[0] - corner[0], p[1] + q[1] - corner[1]), q], colour, THIN)

    def ground(self, a, b, depth=8, step=9):
        """A hatched edge; the material is to the right of the way from a to b."""
        length = hypot(b[0] - a[0], b[1] - a[1])
        for k in range(1, int(length / step) + 1):
            foot, back = towards(a, b, k * step), towards(a, b, k * step - depth)
            self.line([foot, beside(back, b, -depth)[0]], GREY, THIN)
        self.line([a, b], INK, LINE)

    # ----------------------------------------------------------------------------------- bodies

    def capsule(self, a, b, radius, fill=BODY, colour=BODY_EDGE, width=LINE, dash=None, opacity=None):
        """A rod with round ends."""
        if hypot(b[0] - a[0], b[1] - a[1]) < 0.5:
            return self.disc(a, radius, fill, colour, width, dash, opacity)
        turn = atan2(-(b[1] - a[1]), b[0] - a[0])
        outline = circle(b, radius, turn - pi / 2, turn + pi / 2) + circle(a, radius, turn + pi / 2, turn + 3 * pi / 2)
        self.polygon(outline, fill, colour, width, dash, opacity)

    def rods(self, paths, radius, fill=BODY, colour=BODY_EDGE, opacity=None):
        """One body of several rods with round ends, without edges between them."""
        for paint, width in ((colour, 2 * radius + LINE), (fill, 2 * radius - LINE)):
            for path in paths:
                self.line(path, paint, width, opacity=opacity)

    def joint(self, centre, radius=5.5, fill="#ffffff", colour=INK):
        self.disc(centre, radius, fill, colour, LINE + 0.3)

    def blob(self, where, fill=BODY, colour=BODY_EDGE, width=LINE, dash=None, opacity=None):
        """A smooth closed curve through points (Catmull and Rom's spline)."""
        n, path = len(where), f"M{points(where[:1])}"
        for k in range(n):
            before, a, b, after = (where[(k + j) % n] for j in (-1, 0, 1, 2))
            controls = [
                (a[0] + (b[0] - before[0]) / 6, a[1] + (b[1] - before[1]) / 6),
                (b[0] - (after[0] - a[0]) / 6, b[1] - (after[1] - a[1]) / 6),
            ]
            path += f"C{points([*controls, b])}"
        self.shape("path", f'd="{path}Z"', fill, colour, width, dash, opacity)

    # ----------------------------------------------------------------------------------- labels

    def text(self, at, string, anchor="start", size=NORMAL, colour=INK, bold=False, rim=True):
        weight = ' font-weight="bold"' if bold else ""
        self.label(at, escape(string), anchor, size, colour, rim, weight)

    def label(self, at, inner, anchor, size, colour, rim, extra=""):
        halo = ' stroke="#ffffff" stroke-width="4" stroke-linejoin="round" paint-order="stroke"' if rim else ""
        self.out.append(
            f'<text x="{number(at[0])}" y="{number(at[1])}" font-size="{number(size)}" '
            f'text-anchor="{anchor}" fill="{colour}"{halo}{extra}>{inner}</text>'
        )

    def symbol(self, at, markup, anchor="middle", size=SYMBOL, colour=INK, rim=True):
        """A formula; see `runs` for its markup. Pieces (markup, colour) paint its parts."""
        pieces = [(markup, None)] if isinstance(markup, str) else markup
        inner, level = "", 0
        for part, paint in pieces:
            for string, italic, up in runs(part):
                shift = {-1: 0.28, 0: 0.0, 1: -0.36}
                dy = (shift[up] - shift[level]) * size
                level = up
                style = f' dy="{number(dy)}"' if dy else ""
                style += f' font-size="{number(0.72 * size)}"' if up else ""
                style += ' font-style="italic"' if italic else ""
                style += f' fill="{paint}"' if paint else ""
                inner += f"<tspan{style}>{escape(string)}</tspan>" if style else escape(string)
        self.label(at, inner, anchor, size, colour, rim, f' font-family="{SERIF}" xml:space="preserve"')

    def matrix(self, at, rows, cell=(46, 26), size=15, colours=None):
        """A matrix in brackets, its left upper corner at a point; returns the width. A 0 is grey."""
        width, height = cell[0] * len(rows[0]), cell[1] * len(rows)
        for x, tick in ((at[0], 5), (at[0] + width, -5)):
            self.line([(x + tick, at[1]), (x, at[1]), (x, at[1] + height), (x + tick, at[1] + height)], INK, LINE)
        for i, row in enumerate(rows):
            for j, entry in enumerate(row):
                centre = (at[0] + cell[0] * (j + 0.5), at[1] + cell[1] * (i + 0.5) + 0.35 * size)
                colour = "#999999" if entry == "0" else (colours or {}).get((i, j), INK)
                self.symbol(centre, entry, "middle", size, colour)
        return width
