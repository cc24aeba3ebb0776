#!/usr/bin/env python3
"""Makes the textures and the long lists of gallery/: python3 make_gallery.py gallery"""
import math
import pathlib
import random
import struct
import sys
import zlib


def png(file, rows, alpha=False):
    """Writes rows of (r, g, b) or (r, g, b, a) in 0..1, the top row first."""
    depth = 4 if alpha else 3
    data = b""
    for row in rows:
        line = bytes(max(0, min(255, round(255 * c))) for texel in row for c in texel)
        before = bytes(depth) + line
        data += b"\1" + bytes((a - b) % 256 for a, b in zip(line, before))  # filter "sub"

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(
            ">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 6 if alpha else 2, 0, 0, 0)
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
                     chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b""))


def hdr(file, rows):
    """Writes linear rows as Radiance RGBE, not compressed."""
    data = b""
    for row in rows:
        for texel in row:
            most = max(texel)
            if most < 1e-32:
                data += bytes(4)
                continue
            exponent = math.frexp(most)[1]
            data += bytes(min(255, int(c * 256 / 2.0 ** exponent)) for c in texel)
            data += bytes([exponent + 128])
    size = f"-Y {len(rows)} +X {len(rows[0])}\n"
    file.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size.encode() + data)


def mix(a, b, share):
    share = max(0.0, min(1.0, share))
    return tuple(x + (y - x) * share for x, y in zip(a, b))


class Noise:
    """Smooth noise in [0, 1] that repeats after `period` steps."""

    def __init__(self, period, seed):
        numbers = random.Random(seed)
        self.period = period
        self.values = [[numbers.random() for _ in range(period)] for _ in range(period)]

    def at(self, x, y):
        i, j = math.floor(x), math.floor(y)
        a, b = (t * t * (3 - 2 * t) for t in (x - i, y - j))

        def value(di, dj):
            return self.values[(j + dj) % self.period][(i + di) % self.period]

        top = value(0, 0) * (1 - a) + value(1, 0) * a
        return top * (1 - b) + (value(0, 1) * (1 - a) + value(1, 1) * a) * b


def octaves(x, y, seed, period=4, count=4):
    """x and y in [0, 1]."""
    total = weight = 0.0
    for k in range(count):
        share, steps = 0.5 ** k, period * 2 ** k
        total += share * Noise.cached(steps, seed + k).at(x * steps, y * steps)
        weight += share
    return total / weight


def cached(period, seed, made={}):
    if (period, seed) not in made:
        made[period, seed] = Noise(period, seed)
    return made[period, seed]


Noise.cached = staticmethod(cached)


def grid(rows, cols, texel):
    """texel(u, v) at the centres, v from the top."""
    return [[texel((c + 0.5) / cols, (r + 0.5) / rows) for c in range(cols)] for r in range(rows)]


def planet(u, v):
    height = octaves(u, v, 44, count=6)
    away = abs(v - 0.5) * 2 + 0.25 * (octaves(u, v, 30) - 0.5)
    if away > 0.84:
        return (0.93, 0.95, 0.97)
    if height < 0.5:
        return mix((0.03, 0.12, 0.35), (0.10, 0.38, 0.62), height / 0.5)
    return mix((0.22, 0.48, 0.18), (0.72, 0.58, 0.36), (height - 0.5) / 0.2)


def wood(u, v):
    along = u * 8 + 1.6 * octaves(u, v * 0.5, 50) + 0.15 * octaves(u, v, 60, period=16, count=2)
    ring = 0.5 + 0.5 * math.sin(2 * math.pi * along)
    return mix((0.50, 0.30, 0.17), (0.68, 0.46, 0.28), ring)


def arrow(u, v):
    """A frame around an arrow up and a dot at the lower right: shows where an image lies."""
    if min(u, v, 1 - u, 1 - v) < 0.05:
        return (0.12, 0.15, 0.25)
    if (u - 0.78) ** 2 + (v - 0.78) ** 2 < 0.008:
        return (0.85, 0.20, 0.15)
    head = 0.16 < v < 0.45 and abs(u - 0.45) < 0.9 * (v - 0.16)
    if head or (0.44 < v < 0.86 and abs(u - 0.45) < 0.09):
        return (0.10, 0.42, 0.60)
    return mix((0.96, 0.84, 0.55), (0.98, 0.93, 0.80), v)


def tile_height(u, v):
    """Four by four tiles with round edges, each with a dome in its middle."""
    x, y = (4 * u) % 1 - 0.5, (4 * v) % 1 - 0.5
    edge = max(abs(x), abs(y))
    height = max(0.0, min(1.0, (0.47 - edge) / 0.07))
    dome = 0.075 - x * x - y * y
    return 0.03 * height * height * (3 - 2 * height) + 0.6 * max(0.0, dome)


def tile_normal(u, v):
    step = 1.0 / 512
    slope_u = (tile_height(u + step, v) - tile_height(u - step, v)) * 4
    slope_v = (tile_height(u, v - step) - tile_height(u, v + step)) * 4  # v grows upwards
    x, y, z = -slope_u / (8 * step), -slope_v / (8 * step), 1.0
    length = math.sqrt(x * x + y * y + z * z)
    return tuple(0.5 + 0.5 * c / length for c in (x, y, z))


def tile_colour(u, v):
    x, y = (4 * u) % 1 - 0.5, (4 * v) % 1 - 0.5
    if max(abs(x), abs(y)) > 0.45:
        return (0.55, 0.52, 0.48)
    which = int(4 * u) * 3 + int(4 * v) * 5
    return [(0.13, 0.36, 0.50), (0.20, 0.50, 0.55), (0.78, 0.72, 0.58), (0.16, 0.28, 0.42)][
        which % 4]


def leaf(u, v):
    """A pointed leaf with veins; nothing around it."""
    y = 1 - v
    half = 0.42 * math.sin(math.pi * min(1.0, max(0.0, (y - 0.12) / 0.84)) ** 0.85)
    x = u - 0.5
    stalk = y <= 0.2 and abs(x) < 0.022
    inside = 0.12 < y < 0.96 and abs(x) < half * (1 - 0.06 * (math.sin(46 * y) > 0))
    vein = abs(x) < 0.014 or abs((y - 0.7 * abs(x)) * 9 % 1 - 0.5) < 0.07
    green = mix((0.16, 0.42, 0.10), (0.45, 0.62, 0.18), 0.3 + abs(x) + 0.5 * (y - 0.5))
    if vein:
        green = mix(green, (0.72, 0.80, 0.42), 0.6)
    return (*green, 1.0 if inside or stalk else 0.0)


def evening(u, v):
    """Sky with a low sun, linear; u = 0.5 is forward."""
    height = math.sin((0.5 - v) * math.pi)
    towards = math.cos(2 * math.pi * (u - 0.36))
    if height < 0:
        return mix((0.16, 0.12, 0.10), (0.05, 0.05, 0.06), -2 * height)
    sky = mix((0.95, 0.50, 0.22), (0.30, 0.42, 0.70), height * 2.6)
    sky = mix(sky, (0.08, 0.16, 0.42), height * 1.2 - 0.2)
    sky = mix(sky, (0.30, 0.30, 0.46), 0.45 * (0.5 - 0.5 * towards) * (1 - height))
    clouds = octaves(u, v * 2 % 1, 80, period=8, count=3)
    sky = mix(sky, (1.3, 0.85, 0.70), 1.9 * (clouds - 0.53) * (1 - 0.6 * height))
    angle = math.hypot((u - 0.36) * 2 * math.pi, (v - 0.42) * math.pi)
    glow = 2.5 * math.exp(-angle * 5) + (60.0 if angle < 0.055 else 0.0)
    return tuple(c + glow * s for c, s in zip(sky, (1.0, 0.72, 0.42)))


def windows(u, v):
    """A house front at night: some of the windows are lit."""
    x, y = (6 * u) % 1, (8 * v) % 1
    if not (0.25 < x < 0.75 and 0.2 < y < 0.75):
        return (0.0, 0.0, 0.0)
    which = (int(6 * u) * 7 + int(8 * v) * 11 + int(6 * u) * int(8 * v) * 3) % 10
    return [(1.0, 0.82, 0.50), (0.95, 0.70, 0.36), (0.60, 0.78, 1.0)][which] if which < 3 else (
        (0.02, 0.03, 0.05) if which > 4 else (0.9, 0.75, 0.45))


def rounded(numbers):
    return "[" + ", ".join(f"{x:.3f}".rstrip("0").rstrip(".") for x in numbers) + "]"


def listed(rows, indent):
    return (",\n" + " " * indent).join(rounded(row) for row in rows)


def sunflower(count=260):
    """Spheres on a dome, each turned from the last by the golden angle (Vogel 1979)."""
    spheres = []
    for i in range(count):
        share = (i + 0.5) / count
        angle = i * math.pi * (3 - math.sqrt(5))
        ring = math.sin(share * 0.55 * math.pi)
        y = math.cos(share * 0.55 * math.pi)
        spheres.append((1.5 * ring * math.cos(angle), 1.5 * y, 1.5 * ring * math.sin(angle),
                        0.075 + 0.06 * share))
    return spheres


def branches(base, direction, length, radius, depth, numbers):
    """Cones of a tree, and the places of its fruit."""
    tip = tuple(b + length * d for b, d in zip(base, direction))
    cones, fruit = [(*base, radius, *tip, 0.68 * radius)], []
    if depth == 0:
        return cones, [(*tip, 0.10)]
    for k in range(3):
        angle = 2 * math.pi * (k / 3 + numbers.random() * 0.25) + depth
        lean = 0.45 + 0.3 * numbers.random()
        side = (math.cos(angle), 0.0, math.sin(angle))
        along = sum(s * d for s, d in zip(side, direction))
        side = tuple(s - along * d for s, d in zip(side, direction))
        size = math.sqrt(sum(s * s for s in side))
        turned = tuple(math.cos(lean) * d + math.sin(lean) * s / size
                       for d, s in zip(direction, side))
        more = branches(tip, turned, 0.74 * length, 0.66 * radius, depth - 1, numbers)
        cones += more[0]
        fruit += more[1]
    return cones, fruit


def sets_scene():
    cones, fruit = branches((0, 0, 0), (0, 1, 0), 1.05, 0.16, 4, random.Random(5))
    petals = sunflower()
    half = len(petals) // 2
    return f"""// One object each, of many primitives: a tree of {len(cones)} cones with {len(fruit)} round fruits, and a dome of
// {len(petals)} spheres in two materials. Made by make_gallery.py.
{{
    "$schema": "../scene.schema.json",
    "raypick": 1,
    "environment": {{"type": "gradient", "zenith": [0.30, 0.48, 0.75], "horizon": [0.80, 0.86, 0.90]}},
    "ambient": [0.22, 0.24, 0.28],
    "camera": {{"eye": [0.6, 2.6, 8.6], "at": [0.3, 1.5, 0], "fovy": 31}},
    "lights": [
        {{"type": "sphere", "centre": [-6, 9, 6], "radius": 0.9, "colour": [0.95, 0.88, 0.76], "samples": 2}}
    ],
    "materials": {{
        "meadow": {{"diffuse": [0.26, 0.36, 0.16]}},
        "bark": {{"diffuse": [0.30, 0.19, 0.11]}},
        "apple": {{"diffuse": [0.70, 0.10, 0.06], "specular": 0.5, "shininess": 60, "reflect": 0.06, "reflectance": "dielectric"}},
        "honey": {{"diffuse": [0.75, 0.42, 0.06], "specular": 0.5, "shininess": 80}},
        "plum": {{"diffuse": [0.28, 0.10, 0.34], "specular": 0.5, "shininess": 80}}
    }},
    "objects": [
        {{"type": "plane", "name": "meadow", "normal": [0, 1, 0], "material": "meadow"}},
        {{
            "type": "cones", "name": "tree", "material": "bark", "translate": [-1.7, 0, 0],
            "cones": [
                {listed(cones, 16)}
            ]
        }},
        {{
            "type": "spheres", "name": "apples", "material": "apple", "translate": [-1.7, 0, 0],
            "spheres": [
                {listed(fruit, 16)}
            ]
        }},
        {{
            "type": "spheres", "name": "dome", "translate": [2.1, 0.35, 0.6],
            "parts": [
                {{"first": 0, "count": {half}, "material": "honey"}},
                {{"first": {half}, "count": {len(petals) - half}, "material": "plum"}}
            ],
            "spheres": [
                {listed(petals, 16)}
            ]
        }}
    ]
}}
"""


def instances_scene(steps=24):
    """A winding stair: every step is an instance of the first, every post and knob too."""
    items = []
    for i in range(1, steps):
        turn, y = 21.0 * i, 0.17 * i
        angle = math.radians(turn)
        hue = i / (steps - 1)
        colour = mix((0.62, 0.20, 0.12), (0.14, 0.36, 0.55), hue)
        items.append(f"""        {{
            "type": "instance", "name": "step", "of": "first step", "translate": [0, {y:.2f}, 0],
            "rotate": {{"axis": [0, 1, 0], "degrees": {turn:g}}},
            "material": {{"diffuse": {rounded(colour)}, "specular": 0.2, "shininess": 40}}
        }}""")
        place = (1.72 * math.cos(angle), y + 0.12, -1.72 * math.sin(angle))
        items.append(f"""        {{
            "type": "instance", "name": "post", "of": "first post", "translate": {rounded(place)}
        }}""")
        place = (place[0], y + 0.75, place[2])
        items.append(f"""        {{
            "type": "instance", "name": "knob", "of": "first knob", "translate": {rounded(place)},
            "rotate": {{"axis": [0, 1, 0], "degrees": {turn:g}}}, "scale": {rounded((1, 1 + 0.6 * hue, 1))}
        }}""")
    listing = ",\n".join(items)
    return f"""// A winding stair: one step, post and knob, {steps - 1} more of each as instances, and one knot in four places,
// turned, stretched and mirrored. Made by make_gallery.py.
{{
    "$schema": "../scene.schema.json",
    "raypick": 1,
    "environment": {{"type": "gradient", "zenith": [0.42, 0.55, 0.72], "horizon": [0.88, 0.88, 0.86]}},
    "ambient": 0.25,
    "camera": {{"eye": [3.4, 4.6, 11.5], "at": [-0.1, 2.4, 0], "fovy": 34}},
    "lights": [
        {{"type": "sphere", "centre": [5, 11, 7], "radius": 1, "colour": [0.80, 0.76, 0.68], "samples": 2}}
    ],
    "materials": {{
        "floor": {{"diffuse": [0.55, 0.52, 0.47]}},
        "stone": {{"diffuse": [0.60, 0.57, 0.50]}},
        "brass": {{"diffuse": [0.25, 0.16, 0.04], "specular": [0.8, 0.6, 0.3], "shininess": 120, "reflect": [0.55, 0.42, 0.18], "reflectance": "conductor"}},
        "jade": {{"diffuse": [0.06, 0.34, 0.20], "specular": 0.4, "shininess": 60}}
    }},
    "objects": [
        {{"type": "plane", "name": "floor", "normal": [0, 1, 0], "material": "floor"}},
        {{"type": "cylinder", "name": "column", "base": [0, 0, 0], "apex": [0, 4.9, 0], "radius": 0.32, "material": "stone"}},
        {{
            "type": "box", "name": "first step", "min": [0.25, 0, -0.34], "max": [1.9, 0.12, 0.34],
            "material": {{"diffuse": [0.62, 0.2, 0.12], "specular": 0.2, "shininess": 40}}
        }},
        {{
            "type": "sphere", "name": "first knob", "radius": 0.11, "translate": [1.72, 0.75, 0], "material": "brass"
        }},
        {{
            "type": "cylinder", "name": "first post", "base": [0, 0, 0], "apex": [0, 0.6, 0], "radius": 0.03,
            "translate": [1.72, 0.12, 0], "material": "stone"
        }},
{listing},
        {{
            "type": "mesh", "name": "knot", "file": "../knot.ply", "material": "jade",
            "translate": [3.1, 0.85, 1.4], "rotate": {{"axis": [0, 1, 0], "degrees": 35}}, "scale": 0.48
        }},
        {{
            "type": "instance", "name": "flat knot", "of": "knot", "material": "brass",
            "translate": [-2.6, 0.16, 2.6], "rotate": {{"axis": [1, 0, 0], "degrees": -90}}, "scale": [0.62, 0.62, 0.18]
        }},
        {{
            "type": "instance", "name": "mirrored knot", "of": "knot",
            "translate": [-3.4, 0.95, -0.6], "rotate": {{"axis": [0, 1, 0], "degrees": -20}}, "scale": [-0.5, 0.55, 0.5]
        }},
        {{
            "type": "instance", "name": "small knot", "of": "knot", "material": "brass",
            "translate": [1.2, 0.36, 2.9], "rotate": {{"axis": [0, 1, 0], "degrees": 70}}, "scale": 0.22
        }}
    ]
}}
"""


def tumbler(around=64):
    """A closed wall and bottom of glass, as a surface of revolution."""
    profile = [(0.78, 0.004), (0.82, 0.04), (0.955, 1.96), (0.952, 2.0), (0.935, 2.02),
               (0.905, 2.02), (0.888, 2.0), (0.88, 1.96), (0.755, 0.2), (0.70, 0.17)]
    lines = ["# a tumbler, made by make_gallery.py", "o tumbler"]
    for radius, y in profile:
        for i in range(around):
            angle = 2 * math.pi * i / around
            lines.append(f"v {radius * math.cos(angle):.5g} {y:g} {radius * math.sin(angle):.5g}")
    for k in range(len(profile) - 1):
        for i in range(around):
            a, b = k * around + i + 1, k * around + (i + 1) % around + 1
            lines.append(f"f {a} {a + around} {b + around} {b}")
    last = (len(profile) - 1) * around
    lines.append("f " + " ".join(str(i + 1) for i in range(around)))
    lines.append("f " + " ".join(str(last + i) for i in range(around, 0, -1)))
    return "\n".join(lines) + "\n"


def sphere_flake():
    """An NFF file: a ball with nine smaller ones around it, each again with nine."""
    lines = [
        "# A ball with nine smaller ones, each with nine again. Made by make_gallery.py.", "v",
        "from 2.1 -2.6 1.35", "at 0 0 0.08", "up 0 0 1", "angle 32", "hither 0.1",
        "resolution 640 400", "b 0.40 0.58 0.82", "l 4 -3 5 0.62 0.58 0.50",
        "l -3 -4 3 0.22 0.24 0.30", "f 0.75 0.62 0.45 0.9 0 0 0 1", "p 4", "12 12 -0.5",
        "-12 12 -0.5", "-12 -12 -0.5", "12 -12 -0.5"
    ]
    colours = ["0.80 0.55 0.20 0.35 0.5 30 0 1", "0.20 0.45 0.65 0.4 0.5 40 0 1",
               "0.70 0.18 0.15 0.4 0.5 50 0 1"]

    def ring_directions():
        for i in range(6):
            angle = math.radians(60 * i + 10)
            yield (math.cos(angle), math.sin(angle), 0.0)
        for i in range(3):
            angle = math.radians(120 * i + 40)
            yield (math.cos(angle) * 0.6, math.sin(angle) * 0.6, 0.8)

    def frame(up):
        other = (1, 0, 0) if abs(up[0]) < 0.7 else (0, 1, 0)
        along = sum(a * b for a, b in zip(up, other))
        x = tuple(o - along * u for o, u in zip(other, up))
        length = math.sqrt(sum(c * c for c in x))
        x = tuple(c / length for c in x)
        y = (up[1] * x[2] - up[2] * x[1], up[2] * x[0] - up[0] * x[2], up[0] * x[1] - up[1] * x[0])
        return x, y, up

    balls = [[], [], []]

    def add(centre, radius, up, level):
        balls[level].append((*centre, radius))
        if level == 2:
            return
        axes = frame(up)
        for d in ring_directions():
            out = tuple(sum(d[k] * axes[k][i] for k in range(3)) for i in range(3))
            place = tuple(c + radius * 4 / 3 * o for c, o in zip(centre, out))
            add(place, radius / 3, out, level + 1)

    add((0, 0, 0), 0.5, (0, 0, 1), 0)
    for level, colour in zip(balls, colours):
        lines.append("f " + colour)
        lines += ["s " + " ".join(f"{x:.5g}" for x in ball) for ball in level]
    return "\n".join(lines) + "\n"


def main():
    folder = pathlib.Path(sys.argv[1])
    png(folder / "planet.png", grid(128, 256, planet))
    png(folder / "wood.png", grid(96, 96, wood))
    png(folder / "arrow.png", grid(64, 64, arrow))
    png(folder / "tiles.png", grid(128, 128, tile_colour))
    png(folder / "tiles_normal.png", grid(128, 128, tile_normal))
    png(folder / "leaf.png", grid(96, 96, leaf), alpha=True)
    png(folder / "windows.png", grid(64, 48, windows))
    hdr(folder / "evening.hdr", grid(64, 128, evening))
    (folder / "sets.json").write_text(sets_scene())
    (folder / "instances.json").write_text(instances_scene())
    (folder / "tumbler.obj").write_text(tumbler())
    (folder / "sphere-flake.nff").write_text(sphere_flake())


main()
