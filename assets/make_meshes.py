#!/usr/bin/env python3
"""Makes knot.ply and board.obj, the meshes of default.json: python3 make_meshes.py FOLDER"""
import math
import pathlib
import struct
import sys

AROUND = 360  # steps along the knot
SECTION = 28  # steps around its tube


def knot_point(u):
    """The trefoil, a (2, 3) torus knot, standing upright; u in [0, 2 pi)."""
    radius = 1.0 + 0.45 * math.cos(3 * u)
    return (radius * math.cos(2 * u), radius * math.sin(2 * u), 0.62 * math.sin(3 * u))


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    length = math.sqrt(dot(a, a))
    return tuple(x / length for x in a)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def frames():
    """Point, two normals for each step: carried along without twist, the closing gap spread."""
    points = [knot_point(2 * math.pi * i / AROUND) for i in range(AROUND)]
    tangents = [unit(minus(points[(i + 1) % AROUND], points[i - 1])) for i in range(AROUND)]
    normal = unit(cross(tangents[0], (0, 0, 1)))
    first, normals = normal, []
    for tangent in tangents + tangents[:1]:
        along = dot(normal, tangent)
        normal = unit(tuple(n - along * t for n, t in zip(normal, tangent)))
        normals.append(normal)
    gap = math.atan2(dot(cross(first, normals[-1]), tangents[0]), dot(first, normals[-1]))
    return points, tangents, normals, gap


def knot():
    """A tube with five soft ridges that wind along the knot."""
    points, tangents, normals, gap = frames()
    vertices, triangles = [], []
    for i in range(AROUND):
        n, b = normals[i], cross(tangents[i], normals[i])
        untwist = -gap * i / AROUND
        for j in range(SECTION):
            angle = 2 * math.pi * j / SECTION
            winding = 5 * angle + 2 * math.pi * 15 * i / AROUND
            radius = 0.30 * (1 + 0.085 * math.cos(winding))
            c = radius * math.cos(angle + untwist)
            s = radius * math.sin(angle + untwist)
            vertices.append(tuple(p + c * x + s * y for p, x, y in zip(points[i], n, b)))
    for i in range(AROUND):
        for j in range(SECTION):
            a, b = i * SECTION + j, i * SECTION + (j + 1) % SECTION
            c, d = ((k + SECTION) % len(vertices) for k in (a, b))
            triangles += [(a, b, c), (b, d, c)]
    return vertices, triangles


def write_ply(file, vertices, triangles):
    header = f"""ply
format binary_little_endian 1.0
comment trefoil knot, made by make_meshes.py
element vertex {len(vertices)}
property float x
property float y
property float z
element face {len(triangles)}
property list uchar ushort vertex_indices
end_header
"""
    data = b"".join(struct.pack("<3f", *v) for v in vertices)
    data += b"".join(struct.pack("<B3H", 3, *t) for t in triangles)
    file.write_bytes(header.encode() + data)


def board(tiles=8, tile=1.0, height=0.12, rim=0.35):
    """A chess board whose lower side lies in y = 0: tiles in two materials, a frame in a third."""
    half = tiles * tile / 2
    outer = half + rim
    lines = ["# a chess board, made by make_meshes.py", "mtllib board.mtl", "o board"]
    points = []

    def quad(*corners):
        first = len(points) + 1
        for corner in corners:
            points.append("v %g %g %g" % corner)
        return "f %d %d %d %d" % tuple(range(first, first + 4))

    groups = {"ivory": [], "walnut": [], "frame": []}
    for row in range(tiles):
        for col in range(tiles):
            x, z = col * tile - half, row * tile - half
            groups["walnut" if (row + col) % 2 else "ivory"].append(
                quad((x, height, z), (x, height, z + tile), (x + tile, height, z + tile),
                     (x + tile, height, z)))
    inner = [(-half, -half), (-half, half), (half, half), (half, -half)]
    edge = [(-outer, -outer), (-outer, outer), (outer, outer), (outer, -outer)]
    for k in range(4):
        (ax, az), (bx, bz) = edge[k], edge[(k + 1) % 4]
        (cx, cz), (dx, dz) = inner[(k + 1) % 4], inner[k]
        groups["frame"].append(quad((ax, height, az), (bx, height, bz), (cx, height, cz),
                                    (dx, height, dz)))
        groups["frame"].append(quad((ax, height, az), (ax, 0, az), (bx, 0, bz),
                                    (bx, height, bz)))
    groups["frame"].append(quad(*((x, 0, z) for x, z in reversed(edge))))
    lines += points
    for material, faces in groups.items():
        lines += ["usemtl " + material] + faces
    return "\n".join(lines) + "\n"


def main():
    folder = pathlib.Path(sys.argv[1])
    write_ply(folder / "knot.ply", *knot())
    (folder / "board.obj").write_text(board())


main()
