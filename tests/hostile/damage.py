"""Good files, damaged by chance: bytes, texts and values."""
import json
import os
import random

import files
from case import Case

# What is opened, and how: most by `check`, each kind also as it is used.
USES = {
    "camera.json": [["check", "{in}/camera.json"],
                    ["render", "--product", "{in}/tetra.obj", "--look", "{in}/look.json", "--quality", "draft",
                     "--camera", "{in}/camera.json", "--out", "{out}.png"]],
    "look.json": [["check", "{in}/look.json"],
                  ["render", "--product", "{in}/tetra.obj", "--camera", "{in}/camera.json", "--quality", "draft",
                   "--look", "{in}/look.json", "--out", "{out}.exr"]],
    "picture-look.json": [["check", "{in}/picture-look.json"]],
    "material.json": [["check", "{in}/material.json"],
                      ["brdf", "--material", "{in}/material.json", "--in", "{in}/dirs.csv", "--out", "{out}.csv"],
                      ["albedo", "--material", "{in}/material.json", "--mu", "0.5"]],
    "measured-material.json": [["check", "{in}/measured-material.json"]],
    "product.json": [["check", "{in}/product.json"],
                     ["plan", "--product", "{in}/product.json", "--look", "{in}/look.json"]],
    "bench.json": [["check", "{in}/bench.json"],
                   ["photograph", "--bench", "{in}/bench.json", "--patterns", "{in}/patterns", "--out", "{out}"]],
    "xyz.json": [["check", "{in}/xyz.json"]],
    "primaries.json": [["check", "{in}/primaries.json"]],
    "mesh.gltf": [["check", "{in}/mesh.gltf"]],
    "mesh.glb": [["check", "{in}/mesh.glb"]],
    "triangle.bin": [["check", "{in}/mesh.gltf"]],
    "tetra.obj": [["check", "{in}/tetra.obj"]],
    "tetra.ply": [["check", "{in}/tetra.ply"]],
    "dirs.csv": [["check", "{in}/dirs.csv"],
                 ["brdf", "--material", "solid red", "--in", "{in}/dirs.csv", "--out", "{out}.csv"]],
    "nine.csv": [["check", "{in}/nine.csv"],
                 ["brdf", "--material", "{in}/nine.csv", "--in", "{in}/dirs.csv", "--out", "{out}.csv"]],
    "000.png": [["check", "{in}/000.png"]],
    "sky.hdr": [["check", "{in}/sky.hdr"], ["check", "{in}/look.json"]],
    "sky.exr": [["check", "{in}/sky.exr"]],
    "map.exr": [["check", "{in}/map.exr"]],
    "patterns/manifest.json": [["check", "{in}/patterns"],
                               ["photograph", "--bench", "{in}/bench.json", "--patterns", "{in}/patterns",
                                "--out", "{out}"]],
    "captures/manifest.json": [["check", "{in}/captures"],
                               ["calibrate", "color", "--captures", "{in}/captures", "--out", "{out}"]],
    "captures/000.png": [["check", "{in}/captures"]],
    "captures/response.json": [["check", "{in}/captures"]],
    "sphere/manifest.json": [["check", "{in}/sphere"],
                             ["measure", "brdf", "--captures", "{in}/sphere", "--out", "{out}.csv"]],
    "ball/manifest.json": [["check", "{in}/ball"],
                           ["measure", "environment", "--captures", "{in}/ball", "--out", "{out}.exr"]],
    "show.livery": [["check", "{in}/show.livery"], ["session", "show", "{in}/show.livery"],
                    ["session", "export", "{in}/show.livery", "--look", "1", "--out", "{out}.json"]],
}
TEXTS = ["", "..", "../canary/precious.png", "/dev/zero", "/dev/stdin", "a" * 300, "\u0000", "nan", "inf", "*", "%n%s",
         "solid red", "../../../../../../etc/passwd", "data:application/octet-stream;base64,AAAA"]


def flip(chance, data):
    data = bytearray(data)
    for _ in range(chance.choice([1, 1, 2, 4, 16])):
        if data:
            data[chance.randrange(len(data))] = chance.choice([0, 1, 127, 128, 255, chance.randrange(256)])
    return bytes(data)


def cut(chance, data):
    return data[:chance.randrange(len(data) + 1)]


def doubled(chance, data):
    a, b = sorted(chance.randrange(len(data) + 1) for _ in range(2))
    return data[:b] + data[a:b] * chance.choice([1, 2, 50]) + data[b:]


def without(chance, data):
    a = chance.randrange(len(data) + 1)
    return data[:a] + data[a + chance.choice([1, 2, 4, 30]):]


def words(chance, data):
    """Where four bytes are a number, another."""
    data = bytearray(data)
    for _ in range(chance.choice([1, 1, 3])):
        if len(data) > 4:
            k = chance.randrange(len(data) - 3)
            data[k:k + 4] = chance.choice([b"\xff\xff\xff\xff", b"\0\0\0\x80", b"\xff\xff\xff\x7f", b"\0\0\xc0\x7f",
                                           b"\0\0\x80\x7f", b"\x7f\xff\xff\xff", b"\0\0\0\0"])
    return bytes(data)


def other_number(chance, data):
    import re
    text = data.decode("latin-1")
    places = list(re.finditer(r"-?\d+(\.\d+)?(e-?\d+)?", text))
    if not places:
        return flip(chance, data)
    place = chance.choice(places)
    return (text[:place.start()] + chance.choice(files.NUMBERS) + text[place.end():]).encode("latin-1")


def other_value(chance, data):
    try:
        value = json.loads(data)
    except ValueError:
        return flip(chance, data)
    for _ in range(chance.choice([1, 1, 1, 2, 3])):
        places = list(files.leaves(value)) or [()]
        path = chance.choice(places)
        path = path[:chance.randint(max(0, len(path) - 1), len(path))] if path else path
        pick = chance.random()
        if pick < 0.5:
            new = files.Raw(chance.choice(files.NUMBERS))
        elif pick < 0.8:
            new = chance.choice(TEXTS)
        elif pick < 0.9:
            new = files.at(value, chance.choice(places))
        else:
            new = chance.choice([{}, [], [[]], {"a": 1}, [0] * 9, [1, 0, 0, 0, 1, 0, 0, 0, 1]])
        value = files.replaced(value, path, new)
    return files.dump(value).encode()


def cases(seed, count):
    chance = random.Random(seed)
    names = list(USES)
    weights = [3 if name.endswith(".json") or "gltf" in name else 1 for name in names]
    found = []
    for k in range(count):
        name = chance.choices(names, weights)[0]
        uses = USES[name]
        # What draws or traces takes a hundred times as long as looking.
        use = uses[0] if len(uses) == 1 or chance.random() < 0.96 else chance.choice(uses[1:])
        kinds = [flip, cut, doubled, without, words]
        if name.endswith((".json", ".gltf")):
            kinds = [other_value] * 6 + [other_number] * 2 + kinds
        elif name.endswith((".csv", ".obj", ".ply")):
            kinds = [other_number] * 4 + kinds
        kind, own_seed = chance.choice(kinds), chance.randrange(1 << 30)

        def change(inputs, place, name=name, kind=kind, own_seed=own_seed):
            if name == "show.livery":
                (inputs / name).write_bytes(files.SESSION)
            file = inputs / name
            data = file.read_bytes()
            file.write_bytes(kind(random.Random(own_seed), data))

        # A session is locked and its log taken up where it lies.
        may = ("in/show.livery", "in/show.livery-wal", "in/show.livery-shm") if name == "show.livery" else ()
        found.append(Case("damaged-%05d-%s-%s" % (k, name.replace("/", "-"), kind.__name__), use, change, may_change=may + (
            "out.png", "out.exr", "out.csv", "out.json")))
    return found
