"""What each material is made of: where it wants numbers by chance, joints and noise, and what of them.

Assumes that :func:`.pattern.pattern` looks them up. Lengths are metres; indices are those of
:data:`runtime.mesh.MATERIALS`. ``u`` and ``v`` are places on the surface, blur is a pixel's width on it.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from .geometry import bounded, greater, lesser

#: How many numbers by chance they take, and how often noise is looked up for them.
TONES = ((1, 2), (2, 1), (3, 1), (14, 2), (20, 2), (21, 1), (22, 1))
NOISES = (
    (1, 1), (4, 2), (5, 2), (9, 2), (12, 4), (13, 3), (14, 1), (15, 1), (16, 2), (17, 2), (18, 4), (19, 3)
)  # fmt: skip
SEAMED = (1, 2, 3, 6, 14, 19, 21, 22)  # those that have joints both ways


@ti.func
def positive(x):
    return greater(x, 0.0 - x)


@ti.func
def joint(x, width, blur):
    """Coverage 0..1 of a joint ``width`` wide centred on whole numbers (all in periods of x)."""
    d = positive(x - ti.floor(x + 0.5))
    sharp = 1.0 / greater(blur, 1e-4)
    cover = bounded((0.5 * width - d) * sharp + 0.5, 0.0, 1.0)
    # thinner than a pixel: paler instead of broken; and gone before the period is a few pixels
    return cover * (lesser(1.0, width * sharp) * bounded(1.4 - 4.0 * blur, 0.0, 1.0))


@ti.func
def fade(blur, period):
    """1 where a period is many pixels, 0 where it is few."""
    return bounded(1.5 - 4.0 * blur / period, 0.0, 1.0)


@ti.func
def contour(h, level, width, blur):
    """Coverage 0..1 of the line on which a noise ``h`` has a ``level``; width, blur: in units of h."""
    soft = greater(blur, 0.3 * width)
    cover = bounded((0.5 * width - positive(h - level)) / soft + 0.5, 0.0, 1.0)
    return cover * lesser(1.0, width / soft)


@ti.func
def tone_at(material: ti.template(), slot, u, v, upright, first):
    """Of which pair of whole numbers a number by chance is. first: the one found before, of slot 1."""
    a, b = u, v
    if ti.static(material == 1):  # wood
        a, b = course(u * (1.0 / 1.3), ti.floor(v * (1.0 / 0.13)), 7.0, slot, first)
    elif ti.static(material == 2):  # tile
        inverse = 1.0 / 0.15 if upright else 1.0 / 0.3
        a, b = ti.floor(u * inverse), ti.floor(v * inverse)
    elif ti.static(material == 3):  # brick
        line = ti.floor(v / 0.075)
        a, b = ti.floor(u / 0.24 + 0.5 * (line - 2.0 * ti.floor(line * 0.5))), line
    elif ti.static(material == 14):  # stone
        length, height = block(upright)
        a, b = course(u / length, ti.floor(v / height), 11.0, slot, first)
    elif ti.static(material == 20):  # cobble
        a, b = course(u / 0.19, ti.floor(v / 0.16), 3.0, slot, first)
    elif ti.static(material == 21):  # parquet
        strip, i, j, _ = parquet(u, v)
        a, b = ti.floor(strip), i * 57.0 + j * 131.0
    else:  # plate
        a, b = ti.floor(u * (1.0 / 1.2)), ti.floor(v * (1.0 / 0.8))
    return a, b


@ti.func
def course(along, line, seed, slot, shift):
    """A course's own shift (slot 0), then the tone of a block in it."""
    a, b = line, along * 0.0 + seed
    if slot > 0:
        b = ti.floor(along + shift)
    return a, b


@ti.func
def block(upright):
    """Length and height of hewn stones: blocks in a wall, flags on a floor."""
    length, height = 0.8, 0.55
    if upright:
        length, height = 0.62, 0.31
    return length, height


@ti.func
def parquet(u, v):
    """Squares of four strips, every other one across: strips counted, the square, 1 where it is across."""
    side = 1.0 / 0.36
    i, j = ti.floor(u * side), ti.floor(v * side)
    turned = i + j - 2.0 * ti.floor((i + j) * 0.5)
    return ti.select(turned > 0.5, u, v) * side * 4.0, i, j, turned


@ti.func
def noise_at(material: ti.template(), slot, px, py, pz, u, v, upright, blur, noise):
    """Where a material's noise is looked up, and how much of it is seen. noise: that of slot 0"""
    x, y, seen = u, v, 1.0
    if ti.static(material == 1):  # wood
        seen = 0.07 * fade(blur, 0.022)
        x, y = u * 2.4 + 13.0 * ti.floor(v * (1.0 / 0.13)), v * 46.0
        if upright:
            seen = 0.10 * fade(blur, 0.03)
            x, y = u * 34.0, v * 2.2
    elif ti.static(material == 4):  # grass
        x, y = px * 1.1, py * 1.1
        if slot == 1:
            x, y = px * 11.0, py * 11.0 + pz * 7.0
    elif ti.static(material == 5):  # asphalt
        x, y = u * 0.7, v * 0.7
        if slot == 1:
            x, y, seen = u * 55.0, v * 55.0, fade(blur, 0.02)
    elif ti.static(material == 9):  # carpet
        x, y, seen = u * 80.0, v * 80.0, fade(blur, 0.014)
        if slot == 1:
            x, y, seen = u * 3.0, v * 3.0, 1.0
    elif ti.static(material == 12):  # water
        x, y = px * 0.32 + 5.0, py * 0.75
        if slot == 1:
            x, y = px * 0.85, py * 2.3
        elif slot == 2:
            x, y = px * 2.3 + 9.0, py * 5.0
        elif slot == 3:
            x, y = px * 0.55 + 3.0, py * 1.3
    elif ti.static(material == 13):  # sand
        x, y = u * 0.45, v * 0.45
        if slot == 1:
            x, y = u * 0.8, v * 0.5
        elif slot == 2:
            x, y, seen = u * 60.0, v * 60.0, fade(blur, 0.02)
    elif ti.static(material == 14):  # stone
        x, y, seen = u * 12.0, v * 12.0, fade(blur, 0.1)
    elif ti.static(material == 15):  # metal
        x, y, seen = u * 3.0, v * 70.0, fade(blur, 0.02)
    elif ti.static(material == 16):  # leaves
        x, y = px + 0.45 * pz, py - 0.6 * pz
        if slot == 0:
            x, y = x * 4.2, y * 4.2
        else:
            x, y = x * 10.0 + 3.0, y * 10.0
    elif ti.static(material == 17):  # snow
        x, y = u * 0.6, v * 0.6
        if slot == 1:
            x, y = u * 2.7, v * 2.7
    elif ti.static(material == 18):  # earth
        x, y = u * 0.9, v * 0.9
        if slot == 1:
            x, y = u * 6.4 + v * 4.8, v * 6.4 - u * 4.8
        elif slot == 2:
            x, y = u * 9.0, v * 9.0
        elif slot == 3:
            x, y, seen = u * 34.0, v * 34.0, fade(blur, 0.03)
    else:  # marble
        x, y = u * 0.83 + v * 0.56, v * 0.83 - u * 0.56
        if slot == 0:
            x, y = x * 1.1, y * 1.1
        elif slot == 1:
            x, y = x * 0.5 + 0.5 * noise, y * 2.6 + 1.2 * noise
        else:
            x, y = x * 4.0, y * 5.0
    return x, y, seen


@ti.func
def seams_at(material: ti.template(), u, v, upright, blur, first):
    """Where the joints of a material lie, on whole numbers; how wide they and a pixel are there: one way,
    then the other. A width of 0 for none. first: the first number by chance"""
    x, wide, blur_x = v, 0.0, blur
    y, wide_too, blur_y = u, 0.0, blur
    if ti.static(material == 1):  # wood
        if not upright:
            x, wide, blur_x = v * (1.0 / 0.13), 0.004 / 0.13, blur * (1.0 / 0.13)
            y, wide_too, blur_y = u * (1.0 / 1.3) + first, 0.004 / 1.3, blur * (1.0 / 1.3)
    elif ti.static(material == 2):  # tile
        inverse = 1.0 / 0.15 if upright else 1.0 / 0.3
        x, wide, blur_x = v * inverse, 0.005 * inverse, blur * inverse
        y, wide_too, blur_y = u * inverse, 0.005 * inverse, blur * inverse
    elif ti.static(material == 3):  # brick
        x, wide, blur_x = v / 0.075, 0.012 / 0.075, blur / 0.075
        line = ti.floor(x)
        y = u / 0.24 + 0.5 * (line - 2.0 * ti.floor(line * 0.5))
        wide_too, blur_y = 0.012 / 0.24, blur / 0.24
    elif ti.static(material == 6):  # cloth
        if fade(blur, 0.006) > 0:
            x, wide, blur_x = v / 0.006, 0.4, blur / 0.006
            y, wide_too, blur_y = u / 0.006, 0.4, blur / 0.006
    elif ti.static(material == 14):  # stone
        length, height = block(upright)
        gap = 0.016 if upright else 0.014
        x, wide, blur_x = v / height, gap / height, blur / height
        y, wide_too, blur_y = u / length + first, gap / length, blur / length
    elif ti.static(material == 19):  # marble
        x, wide, blur_x = v / 0.8, 0.01, blur / 0.8
        y, wide_too, blur_y = u / 0.8, 0.01, blur / 0.8
    elif ti.static(material == 21):  # parquet
        side = 1.0 / 0.36
        x, wide, blur_x = v * side, 0.012, blur * side
        y, wide_too, blur_y = u * side, 0.012, blur * side
    else:  # plate
        x, wide, blur_x = v * (1.0 / 0.8), 0.016 / 0.8, blur / 0.8
        y, wide_too, blur_y = u * (1.0 / 1.2), 0.016 / 1.2, blur / 1.2
    return x, wide, blur_x, y, wide_too, blur_y


@ti.func
def finish(
    material: ti.template(),
    place: ti.template(),
    upright,
    blur,
    tone: ti.template(),
    seams: ti.template(),
    noise: ti.template(),
):
    """Factor of one of GRAINED, of what was found: numbers by chance, joints across and along, and noise.

    place: x, y and z in the world, and two coordinates on the surface
    """
    px, py, pz, u, v = place[0], place[1], place[2], place[3], place[4]
    out = u * 0.0 + 1.0
    if ti.static(material == 1):  # wood
        if upright:
            out = 1.0 + (noise[0] - 0.5) * (0.10 * fade(blur, 0.03))
        else:
            out = 1.0 + (tone[1] - 0.5) * 0.13 * fade(blur, 0.13)
            out += (noise[0] - 0.5) * (0.07 * fade(blur, 0.022))
            out *= 1.0 - 0.3 * greater(seams[0], seams[1])
    elif ti.static(material == 2):  # tile
        size = 0.15 if upright else 0.3
        out = 1.0 + (tone[0] - 0.5) * 0.05 * fade(blur, size)
        out *= 1.0 - 0.24 * greater(seams[0], seams[1])
    elif ti.static(material == 3):  # brick
        out = 1.0 + (tone[0] - 0.5) * 0.2 * fade(blur, 0.12)
        out *= 1.0 + 0.28 * greater(seams[0], seams[1])
    elif ti.static(material == 4):  # grass
        patch = bounded((noise[0] - 0.42) * 6.0, 0.0, 1.0)
        blade = bounded((noise[1] - 0.62) * 7.0, 0.0, 1.0)
        out = 0.95 + 0.09 * patch - 0.13 * blade * fade(blur, 0.12)
    elif ti.static(material == 5):  # asphalt
        out = 1.0 + (noise[0] - 0.5) * 0.08
        out += (noise[1] - 0.5) * (0.16 * fade(blur, 0.02))
    elif ti.static(material == 6):  # cloth
        out = 1.0 - 0.05 * fade(blur, 0.006) * (seams[1] + seams[0])
    elif ti.static(material == 9):  # carpet
        out = 1.0 + (noise[0] - 0.5) * (0.16 * fade(blur, 0.014))
        out *= 1.0 + (noise[1] - 0.5) * 0.05
    elif ti.static(material == 12):  # water: broken strokes of light on slow swells
        wave = noise[1] * 0.7 + noise[2] * 0.3
        light = contour(wave, 0.56, 0.075, blur * 2.6) + 0.6 * contour(wave, 0.34, 0.05, blur * 2.6)
        some = bounded((noise[3] - 0.3) * 3.0, 0.0, 1.0)
        out = 0.97 + (noise[0] - 0.5) * 0.16 + 0.3 * light * some * fade(blur, 0.35)
    elif ti.static(material == 13):  # sand: ripples the wind made, and grains
        bent = v * 2.6 + 1.6 * noise[1] + 0.35 * u
        crest = positive(bent - ti.floor(bent) - 0.5) * 2.0
        out = 1.0 + (noise[0] - 0.5) * 0.09 + (crest - 0.5) * 0.12 * fade(blur, 0.38)
        out += (noise[2] - 0.5) * (0.12 * fade(blur, 0.02))
    elif ti.static(material == 14):  # stone: hewn blocks in courses, each course shifted, and darker joints
        height = block(upright)[1]
        varied = 0.18 if upright else 0.16
        out = 1.0 + (tone[1] - 0.5) * varied * fade(blur, height)
        out *= 1.0 - 0.28 * greater(seams[0], seams[1])
        out += (noise[0] - 0.5) * (0.07 * fade(blur, 0.1))
    elif ti.static(material == 15):  # metal: broad slanting sheens, brushed along u
        sheen = (px + py) * 0.55 + pz * 0.8
        sheen = positive(sheen - ti.floor(sheen) - 0.5) * 2.0
        sheen = sheen * sheen * (3 - 2 * sheen)
        out = 0.99 + (sheen - 0.46) * 0.13
        out += (noise[0] - 0.5) * (0.07 * fade(blur, 0.02))
    elif ti.static(material == 16):  # leaves: light and dark clumps, the same whichever way a face looks
        clump = noise[0] * 0.6 + noise[1] * 0.4
        bright = bounded((clump - 0.55) * 9.0, 0.0, 1.0)
        dark = bounded((0.44 - clump) * 9.0, 0.0, 1.0)
        out = 1.0 + (0.12 * bright - 0.13 * dark) * fade(blur, 0.2)
    elif ti.static(material == 17):  # snow: soft drifts
        out = 1.0 + (noise[0] - 0.5) * 0.07
        out += (noise[1] - 0.5) * 0.045 * fade(blur, 0.3)
    elif ti.static(material == 18):  # earth: trodden patches and pebbles
        pebble = bounded((noise[1] * 0.6 + noise[2] * 0.4 - 0.6) * 9.0, 0.0, 1.0)
        out = 1.0 + (noise[0] - 0.5) * 0.16 + (0.025 - 0.13 * pebble) * fade(blur, 0.12)
        out += (noise[3] - 0.5) * (0.1 * fade(blur, 0.03))
    elif ti.static(material == 19):  # marble: veins that run aslant over large slabs
        vein = noise[1] * 0.8 + noise[2] * 0.2
        strong = contour(vein, 0.5, 0.04, blur * 2.2) + 0.6 * contour(vein, 0.7, 0.04, blur * 2.2)
        out = 1.02 + (noise[0] - 0.5) * 0.11 - 0.2 * strong * fade(blur, 0.3)
        out *= 1.0 - 0.2 * greater(seams[0], seams[1])
    elif ti.static(material == 20):  # cobble: small rounded stones in courses
        row, along = v / 0.16, u / 0.19 + tone[0]
        x, y = along - ti.floor(along) - 0.5, row - ti.floor(row) - 0.5
        edge = greater(positive(x), positive(y)) + 0.35 * (x * x + y * y)
        soft = greater(blur / 0.16, 0.08)
        seam = bounded((edge - 0.5) / soft + 0.5, 0.0, 1.0)
        out = 1.05 + ((tone[1] - 0.5) * 0.17 - 0.26 * seam) * fade(blur, 0.17)
    elif ti.static(material == 21):  # parquet
        strip, _, _, turned = parquet(u, v)
        seam = greater(joint(strip, 0.045, blur * (1.0 / 0.36) * 4.0), greater(seams[0], seams[1]))
        shade = (tone[0] - 0.5) * 0.13 * fade(blur, 0.12)
        out = (1.015 + shade + (turned - 0.5) * 0.05) * (1.0 - 0.22 * seam)
    else:  # plate: sheets of metal with seams between them
        out = 1.0 + (tone[0] - 0.5) * 0.07 * fade(blur, 0.8)
        out *= 1.0 - 0.26 * greater(seams[0], seams[1])
        sheen = (px - py) * 0.4 + pz * 0.6
        out += (positive(sheen - ti.floor(sheen) - 0.5) - 0.25) * 0.16
    return out
