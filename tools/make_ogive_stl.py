#!/usr/bin/env python3
"""Writes a closed triangle mesh of a rod with a tangent-ogive nose as STL.

The tip is the origin and the body lies along -z, so the rod flies towards +z. Any unit of length.

  r    radius, half the diameter d              C    caliber-radius-head: R = C d is the radius of the ogive's arc
  h    nose length, sqrt(R^2 - (R - r)^2)       L    length over all, L >= h

Radius of the nose at distance s behind the tip (0 <= s <= h; the arc's centre lies beside the shoulder):

  rho(s) = sqrt(R^2 - (h - s)^2) - (R - r)

Exact volume of the solid, with b = R - r:

  V = pi r^2 (L - h) + pi [ (R^2 + b^2) h - h^3 / 3 - b h sqrt(R^2 - h^2) - b R^2 asin(h / R) ]

(the bracket is the integral of rho^2 over the nose; sqrt(R^2 - h^2) = b). With d = 12.9, L = 88.9, C = 3: V = 10352.46.

All vertices lie on the solid's surface, so the mesh encloses a little less: (2 pi / n)^2 / 6 of it for n facets around.
Nothing compensates for that; take enough facets. The mesh is symmetric about the planes x = 0 and y = 0 to the last
bit, vertices and triangles alike, because a half model of it must be exactly half.

  make_ogive_stl.py rod.stl --diameter 12.9 --length 88.9 --crh 3
"""

import argparse
import math
import struct
import sys


def exact_volume(diameter, length, crh):
    r, big = diameter / 2, crh * diameter
    b = big - r
    h = math.sqrt(big**2 - b**2)
    nose = (big**2 + b**2) * h - h**3 / 3 - b * h * math.sqrt(big**2 - h**2) - b * big**2 * math.asin(h / big)
    return math.pi * (r**2 * (length - h) + nose)


def profile(diameter, length, crh, nose_segments, body_segments):
    """(radius, z) of the rings, from the first behind the tip to the end."""
    r, big = diameter / 2, crh * diameter
    h = math.sqrt(big**2 - (big - r) ** 2)
    whole = math.asin(h / big)  # angle of the arc from shoulder to tip
    rings = []
    for k in range(1, nose_segments):
        angle = whole * (1 - k / nose_segments)
        rings.append((big * math.cos(angle) - (big - r), -(h - big * math.sin(angle))))
    rings.append((r, -h))
    if length > h:
        rings += [(r, -(h + (length - h) * k / body_segments)) for k in range(1, body_segments + 1)]
    return rings


def circle(facets):
    """(cos, sin) around; the first quadrant mirrored into the others, so that signs are all that differ."""
    quarter = facets // 4
    first = [(math.cos(2 * math.pi * k / facets), math.sin(2 * math.pi * k / facets)) for k in range(quarter + 1)]
    first[0], first[quarter] = (1.0, 0.0), (0.0, 1.0)
    points = []
    for k in range(facets):
        quadrant, i = divmod(k, quarter)
        c, s = first[i] if quadrant % 2 == 0 else first[quarter - i]
        points.append((c if quadrant in (0, 3) else -c, s if quadrant in (0, 1) else -s))
    return points


def triangles(diameter, length, crh, facets, nose_segments, body_segments):
    rings = profile(diameter, length, crh, nose_segments, body_segments)
    around = circle(facets)
    at = [[(radius * c, radius * s, z) for c, s in around] for radius, z in rings]
    tip, tail = (0.0, 0.0, 0.0), (0.0, 0.0, rings[-1][1])
    result = []
    for k in range(facets):
        n = (k + 1) % facets
        result.append((tip, at[0][k], at[0][n]))
        for front, back in zip(at, at[1:]):
            # Rounding leaves the four corners not quite in one plane, so the diagonals must be mirror images too.
            if k * 4 // facets % 2 == 0:
                result += [(front[k], back[k], back[n]), (front[k], back[n], front[n])]
            else:
                result += [(front[k], back[k], front[n]), (front[n], back[k], back[n])]
        result.append((tail, at[-1][n], at[-1][k]))
    return result


def as_single(point):
    """Coordinates as STL keeps them; 0.0 for -0.0."""
    return tuple(x + 0.0 for x in struct.unpack("<3f", struct.pack("<3f", *point)))


def normal(a, b, c):
    u, v = [b[i] - a[i] for i in range(3)], [c[i] - a[i] for i in range(3)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    size = math.sqrt(sum(x * x for x in n))
    return tuple(x / size for x in n)


def enclosed_volume(mesh):
    return math.fsum(
        (
            a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
        )
        / 6
        for a, b, c in mesh
    )


def main():
    parser = argparse.ArgumentParser(
        description="Writes a closed triangle mesh of a tangent-ogive rod: tip at the origin, body along -z.",
        epilog="More, and the exact volume of the solid, at the head of this script.",
    )
    parser.add_argument("output", help="STL file to write")
    parser.add_argument("--diameter", type=float, required=True, help="of the body")
    parser.add_argument("--length", type=float, required=True, help="over all")
    parser.add_argument("--crh", type=float, required=True, help="radius of the ogive's arc / diameter, >= 0.5")
    parser.add_argument("--facets", type=int, default=144, help="around, a multiple of 4 (default %(default)s)")
    parser.add_argument("--nose-segments", type=int, default=48, help="along the nose (default %(default)s)")
    parser.add_argument("--body-segments", type=int, default=16, help="along the body (default %(default)s)")
    parser.add_argument("--ascii", action="store_true", help="text instead of binary")
    args = parser.parse_args()

    numbers = {name: getattr(args, name) for name in ("diameter", "length", "crh")}
    for name, value in numbers.items():
        if not (math.isfinite(value) and value > 0):
            parser.error(f"--{name} {value}: expected a finite number > 0")
    if args.crh < 0.5:
        parser.error(f"--crh {args.crh}: expected at least 0.5, a hemisphere")
    nose = args.diameter * math.sqrt(args.crh - 0.25)
    if args.length < nose:
        parser.error(f"--length {args.length}: expected at least the length of the nose, {nose:.6g}")
    if args.facets < 4 or args.facets % 4:
        parser.error(f"--facets {args.facets}: expected a multiple of 4")
    if args.nose_segments < 1 or args.body_segments < 1:
        parser.error("--nose-segments and --body-segments: expected at least 1")

    mesh = triangles(args.diameter, args.length, args.crh, args.facets, args.nose_segments, args.body_segments)
    mesh = [tuple(as_single(p) for p in facet) for facet in mesh]
    if args.ascii:
        with open(args.output, "w", encoding="ascii", newline="\n") as out:
            out.write("solid ogive rod\n")
            for facet in mesh:
                out.write("facet normal {:.6g} {:.6g} {:.6g}\nouter loop\n".format(*normal(*facet)))
                for point in facet:
                    out.write("vertex {:.9g} {:.9g} {:.9g}\n".format(*point))  # 9 digits give each single back
                out.write("endloop\nendfacet\n")
            out.write("endsolid ogive rod\n")
    else:
        header = f"ogive rod: diameter {args.diameter:g}, length {args.length:g}, CRH {args.crh:g}".encode()
        with open(args.output, "wb") as out:
            out.write(header[:80].ljust(80, b"\0") + struct.pack("<I", len(mesh)))
            for facet in mesh:
                out.write(struct.pack("<12fH", *normal(*facet), *(x for p in facet for x in p), 0))

    exact, meshed = exact_volume(args.diameter, args.length, args.crh), enclosed_volume(mesh)
    print(
        f"{args.output}: {len(mesh)} triangles, encloses {meshed:.6f}, the solid {exact:.6f} "
        f"({100 * (meshed / exact - 1):+.4f} %)"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
