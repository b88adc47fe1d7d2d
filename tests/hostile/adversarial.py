"""What somebody would write who wants the program to fall: one case each."""
import math
import os
import struct

import files
from case import Case
from files import Raw, dump, replaced

DRAW = ["render", "--product", "{in}/tetra.obj", "--quality", "draft", "--look", "{in}/look.json",
        "--camera", "{in}/camera.json", "--out", "{place}/out/a.exr"]
PHOTOGRAPH = ["photograph", "--bench", "{in}/bench.json", "--patterns", "{in}/patterns", "--out", "{out}"]
# What opens a file and what uses it.
JSONS = {
    "camera.json": (files.CAMERA, DRAW),
    "look.json": (files.LOOK, DRAW),
    "material.json": (files.MATERIAL, ["brdf", "--material", "{in}/material.json", "--in", "{in}/dirs.csv",
                                       "--out", "{place}/out/a.csv"]),
    "product.json": (files.PRODUCT, ["plan", "--product", "{in}/product.json", "--look", "{in}/look.json"]),
    "bench.json": (files.BENCH, PHOTOGRAPH),
    "xyz.json": (files.XYZ, ["check", "{in}/xyz.json"]),
    "primaries.json": (files.PRIMARIES, ["check", "{in}/primaries.json"]),
    "patterns/manifest.json": (files.PATTERNS, PHOTOGRAPH),
    "captures/manifest.json": (files.CAPTURES, ["calibrate", "color", "--captures", "{in}/captures", "--out", "{out}"]),
    "captures/response.json": (files.RESPONSE, ["check", "{in}/captures"]),
    "sphere/manifest.json": (files.SPHERE, ["measure", "brdf", "--captures", "{in}/sphere",
                                            "--out", "{place}/out/a.csv"]),
    "ball/manifest.json": (files.BALL, ["measure", "environment", "--captures", "{in}/ball",
                                        "--out", "{place}/out/a.exr"]),
    "spot/manifest.json": (files.SPOT, ["measure", "profile", "--captures", "{in}/spot",
                                        "--out", "{place}/out/a.csv"]),
    "mesh.gltf": (files.GLTF, ["check", "{in}/mesh.gltf"]),
}


def slug(path):
    return "-".join(str(p) for p in path).replace("/", "_")


def make_out(inputs, place):
    (place / "out").mkdir(exist_ok=True)


def put(name, text):
    def change(inputs, place):
        make_out(inputs, place)
        data = text.encode("utf-8", "surrogateescape") if isinstance(text, str) else text
        (inputs / name).write_bytes(data)
    return change


def numbers():
    """Every number of every JSON file, at its worst."""
    for name, (value, use) in JSONS.items():
        for path in files.leaves(value):
            here = files.at(value, path)
            if isinstance(here, (bool, str)) or here is None:
                continue
            for number in ("1e308", "1e20", "-1e155", "0", "1e-320", "1e999"):
                # All of a row of nine would say nothing new.
                if number in ("0", "1e-320", "1e20") and path and path[-1] not in (0, 1, "width", "height") and isinstance(
                        path[-1], int):
                    continue
                text = dump(replaced(value, path, Raw(number)))
                quick = number == "1e308" and name in ("camera.json", "look.json") and path[-1] in (0, "width")
                yield Case("number-%s-%s-%s" % (name.replace("/", "-"), slug(path), number), use, put(name, text), quick)


def nesting():
    """Brackets inside one another, where a value is expected and where nobody looks."""
    for name, (value, use) in JSONS.items():
        for kind, opened, closed in (("arrays", "[", "]"), ("objects", '{"a":', "}")):
            for depth in (1000, 100000):
                deep = opened * depth + ("1" if opened == "[" else "1") + closed * depth
                first = next(iter(value))
                whole = dump({**value, first: Raw(deep)})
                yield Case("nested-%s-%s-%d" % (name.replace("/", "-"), kind, depth), ["check", "{in}/" + name],
                           put(name, whole), quick=kind == "arrays" and depth == 100000, exit_codes=(1, 2),
                           says="inside one another")
    for command in ("[" * 50000 + "]" * 50000, '{"set-eye":{"eye_mm":' + "[" * 5000 + "]" * 5000 + "}}"):
        yield Case("nested-command-%d" % len(command), ["session", "apply", "{in}/show.livery", "--command", command],
                   session, exit_codes=(1, 2))


def session(inputs, place):
    make_out(inputs, place)
    (inputs / "show.livery").write_bytes(files.SESSION)


# Whoever names a file in a file may try these.
def names(inputs, place):
    return {"above": "../canary/precious.png", "text": "../canary/precious.txt",
            "absolute": str(place / "canary/precious.png"), "zero": "/dev/zero", "stdin": "/dev/stdin",
            "random": "/dev/urandom", "memory": "/proc/self/mem", "passwd": "/etc/passwd", "fifo": "fifo",
            "folder": ".", "empty": "", "long": "a" * 1000000, "nul": "000.png\u0000/../../canary/precious.png",
            "line": "a\nb\u001b[2J", "link": "link.png", "missing": "no/such/file.png"}


FIELDS = {
    "patterns/manifest.json": (files.PATTERNS, [("captures", 0, "pattern")], [PHOTOGRAPH, ["check", "{in}/patterns"]]),
    "captures/manifest.json": (files.CAPTURES, [("captures", 0, "file"), ("captures", 0, "pattern"),
                                                ("captures", 0, "transfer")], [["check", "{in}/captures"]]),
    "sphere/manifest.json": (files.SPHERE, [("camera",), ("camera_to_xyz",), ("captures", 0, "file"),
                                            ("white_reference", "file")],
                             [["measure", "brdf", "--captures", "{in}/sphere", "--out", "{place}/out/a.csv"]]),
    "ball/manifest.json": (files.BALL, [("views", 0, "camera"), ("camera_to_xyz",), ("views", 0, "mask"),
                                        ("views", 0, "captures", 0, "file")],
                           [["measure", "environment", "--captures", "{in}/ball", "--out", "{place}/out/a.exr"]]),
    "spot/manifest.json": (files.SPOT, [("camera",), ("captures", 0, "file"),
                                        ("white_reference", "black", 0, "file")],
                           [["measure", "profile", "--captures", "{in}/spot", "--out", "{place}/out/a.csv"]]),
    "look.json": (files.LOOK, [("parts", "*"), ("environment", "file"), ("artwork", 0, "paint")], [DRAW]),
    "picture-look.json": (files.PICTURE_LOOK, [("artwork", 0, "picture")], [["check", "{in}/picture-look.json"]]),
    "measured-material.json": (files.MEASURED_MATERIAL, [("parameters", "file")],
                               [["check", "{in}/measured-material.json"]]),
    "product.json": (files.PRODUCT, [("mesh",)], [["check", "{in}/product.json"]]),
    "bench.json": (files.BENCH, [("base",), ("product",)], [PHOTOGRAPH]),
    "mesh.gltf": (files.GLTF, [("buffers", 0, "uri")], [["check", "{in}/mesh.gltf"]]),
}


def paths():
    """Files that name other files."""
    for name, (value, fields, uses) in FIELDS.items():
        for field in fields:
            for kind in names(None, __import__("pathlib").Path("/")):
                for use in uses:
                    def change(inputs, place, name=name, value=value, field=field, kind=kind):
                        make_out(inputs, place)
                        folder = (inputs / name).parent
                        files.make_fifo(folder / "fifo")
                        if not (folder / "link.png").is_symlink():
                            os.symlink("../../canary/precious.png", folder / "link.png")
                        (inputs / name).write_text(dump(replaced(value, field, names(inputs, place)[kind])))
                    yield Case("path-%s-%s-%s-%s" % (name.replace("/", "-"), slug(field), kind, use[0]), use, change,
                               quick=kind in ("above", "fifo") and use[0] != "measure")
    for kind in ("above", "fifo", "passwd", "long"):
        def change(inputs, place, kind=kind):
            make_out(inputs, place)
            files.make_fifo(inputs / "fifo")
            (inputs / "tetra.obj").write_text("mtllib " + names(inputs, place)[kind] + "\n" + files.TETRA_OBJ)
        yield Case("path-obj-mtllib-" + kind, ["check", "{in}/tetra.obj"], change)
    for word in ("fifo", "."):
        def change(inputs, place):
            files.make_fifo(inputs / "fifo")
        for command in (["check", "{in}/" + word], ["render", "--camera", "{in}/" + word, "--out", "{out}.png"],
                        ["fit", "brdf", "--measured", "{in}/" + word, "--out", "{out}.json"],
                        ["session", "show", "{in}/" + word]):
            yield Case("path-argument-%s-%s" % (word.replace(".", "folder"), command[0]), command, change,
                       exit_codes=(1, 2), may_change=("out.png", "out.json"))

    def pictures(inputs, place):
        for k in range(42):
            files.make_fifo(inputs / ("%03d.png" % (100 + k)))
    yield Case("path-fifos-as-photographs", ["check", "{in}"], pictures)

    # Written names come from no file: the pattern would land on the canary beside --out.
    def climbing(inputs, place):
        (place / "in/precious.png").write_bytes(files.png(grey=1))
        manifest = replaced(files.PATTERNS, ("captures", 0, "pattern"), "../precious.png")
        (inputs / "patterns/manifest.json").write_text(dump(manifest))
        (place / "precious.png").write_bytes(b"mine")
    yield Case("photograph-climbs", PHOTOGRAPH, climbing, quick=True, exit_codes=(0,))


def sizes():
    """Declared, and not there."""
    big = 1 << 30
    for kind, data in {
            "png": files.png(declared=(60000, 60000)), "png-side": files.png(declared=(1000000, 1000000)),
            "exr": files.exr(declared=(30000, 30000), filled=False),
            "exr-one-row": files.exr(declared=(90000000, 1), filled=False),
            "exr-negative": files.exr(declared=(-5, 7), filled=False),
            "hdr": files.hdr(declared=(30000, 30000)), "hdr-most": files.hdr(declared=(2147483647, 2147483647))}.items():
        suffix = kind.split("-")[0]
        yield Case("size-" + kind, ["check", "{in}/big." + suffix], put("big." + suffix, data), quick=True,
                   exit_codes=(1,))
    for count in (100, 1000):
        names = ["c%04d" % k for k in range(count)]
        yield Case("size-exr-channels-%d" % count, ["check", "{in}/big.exr"],
                   put("big.exr", files.exr(names, declared=(10000, 10000), filled=False)), exit_codes=(1,))

    # Deflated to a thousandth, and all there: 25 kB for gigabytes.
    def thin(width, height, channels):
        return lambda inputs, place: (make_out(inputs, place), (inputs / "big.exr").write_bytes(
            files.exr(channels, width=width, height=height)))
    for width, height, channels in ((8000, 2000, ("B", "G", "R")), (4000, 4000, tuple("c%02d" % k for k in range(20))),
                                    (16000, 8000, ("B", "G", "R"))):
        yield Case("size-exr-thin-%dx%dx%d" % (width, height, len(channels)), ["check", "{in}/big.exr"],
                   thin(width, height, channels), cpu_s=10)
    for name, text in {
            "ply-count": files.PLY.replace("vertex 4", "vertex 4000000000"),
            "ply-list": files.PLY.replace("3 0 1 2", "255 0 1 2"),
            "obj-index": files.TETRA_OBJ + "f 1 2 999999999999\n",
            "csv-columns": ",".join("c%d" % k for k in range(200000)) + "\n1\n",
            "brdf-wavelengths": "1000000000\n400 500\n"}.items():
        suffix = name.split("-")[0]
        yield Case("size-" + name, ["check", "{in}/big." + suffix], put("big." + suffix, text), exit_codes=(1,))
    yield Case("size-merl", ["check", "{in}/big.binary"],
               put("big.binary", struct.pack("<3i", big, big, big)), exit_codes=(1,))

    def sparse(name, count):
        def change(inputs, place):
            make_out(inputs, place)
            with open(inputs / name, "wb") as file:
                file.truncate(count)
        return change
    for name in ("a.json", "a.glb", "a.gltf", "a.obj", "a.ply", "a.csv", "a.brdf", "a.png", "a.exr", "a.hdr", "a.livery",
                 "a.binary"):
        yield Case("size-sparse-" + name, ["check", "{in}/" + name], sparse(name, 40 << 30), quick=name == "a.json",
                   exit_codes=(1,))
    yield Case("size-values", ["check", "{in}/a.json"], put("a.json", '{"a":[' + "[]," * 20000000 + "[]]}"),
               exit_codes=(1,))


def gltfs():
    def gltf(**members):
        return {**files.GLTF, **members}

    def case(name, value, says="", quick=False, codes=(1,)):
        return Case("gltf-" + name, ["check", "{in}/mesh.gltf"], put("mesh.gltf", dump(value)), quick, exit_codes=codes,
                    says=says)

    def same_file(inputs, place):
        make_out(inputs, place)
        (inputs / "triangle.bin").write_bytes(b"\0" * 160000)
        (inputs / "mesh.gltf").write_text(dump(gltf(buffers=[{"byteLength": 160000, "uri": "triangle.bin"}] * 50000)))
    yield Case("gltf-50000-buffers", ["check", "{in}/mesh.gltf"], same_file, quick=True)

    def many_files(inputs, place):
        make_out(inputs, place)
        (inputs / "triangle.bin").write_bytes(b"\0" * 160000)
        for k in range(300):
            os.symlink("triangle.bin", inputs / ("b%d.bin" % k))
        with open(inputs / "large.bin", "wb") as file:
            file.truncate(700 << 20)
        names = ["b%d.bin" % k for k in range(300)]
        buffers = [{"byteLength": 160000, "uri": n} for n in names] + [{"byteLength": 9, "uri": "./large.bin"},
                                                                      {"byteLength": 9, "uri": "x/../large.bin"}]
        (inputs / "mesh.gltf").write_text(dump(gltf(buffers=buffers)))
    yield Case("gltf-large-buffers", ["check", "{in}/mesh.gltf"], many_files)

    def pictures(inputs, place):
        make_out(inputs, place)
        (inputs / "large.png").write_bytes(files.png(4096, 4096))
        materials = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": k}, "metallicRoughnessTexture": {"index": k + 1}}}
                     for k in range(0, 60, 2)]
        (inputs / "mesh.gltf").write_text(dump(gltf(images=[{"uri": "large.png"}] * 60, materials=materials,
                                                    textures=[{"source": k} for k in range(60)])))
    yield Case("gltf-large-pictures", ["check", "{in}/mesh.gltf"], pictures)
    position, index = files.GLTF["accessors"]
    zeros = {"componentType": 5126, "count": 33000000, "type": "VEC3"}
    yield case("zeros", gltf(accessors=[zeros, index]), quick=True)
    yield case("zero-indices", gltf(accessors=[position, {"componentType": 5125, "count": 33000000, "type": "SCALAR"}]),
               quick=True)
    yield case("count", gltf(accessors=[{**position, "count": 2147483647}, index]))
    yield case("negative", gltf(accessors=[{**position, "count": -3}, index]))
    yield case("offset", gltf(accessors=[{**position, "byteOffset": 2147483647}, index]))
    yield case("view", gltf(bufferViews=[{"buffer": 0, "byteOffset": 2147483647, "byteLength": 2147483647}] * 2))
    yield case("self-child", gltf(nodes=[{"mesh": 0, "children": [0]}]))
    yield case("cycle", gltf(nodes=[{"mesh": 0, "children": [1]}, {"children": [0]}]))
    yield case("no-scene", gltf(scene=7))
    yield case("no-mesh", gltf(nodes=[{"mesh": 7}]))
    yield case("empty", {"asset": {"version": "2.0"}}, says="no triangles")
    yield case("nothing", {})
    yield case("points", gltf(meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]}]),
               says="points dropped", quick=True)
    yield case("far", gltf(nodes=[{"mesh": 0, "translation": [1e11, 0, 0]}]))
    yield case("scale", gltf(nodes=[{"mesh": 0, "scale": [1e12, 1e12, 1e12]}]))
    chain = [{"children": [k + 1], "scale": [1e12, 1e12, 1e12]} for k in range(60)] + [{"mesh": 0}]
    yield case("scale-chain", gltf(nodes=chain))
    yield case("zero-scale", gltf(nodes=[{"mesh": 0, "scale": [0, 0, 0]}]))
    chain = [{"children": [k + 1]} for k in range(100000)] + [{"mesh": 0}]
    yield case("long-chain", gltf(nodes=chain), codes=())
    uses = gltf(nodes=[{"mesh": 0}] * 100000, scenes=[{"nodes": list(range(100000))}])
    yield case("many-nodes", uses, codes=())
    primitive = {"attributes": {"POSITION": 0}, "mode": 0}
    uses = gltf(nodes=[{"mesh": 0}] * 2000, scenes=[{"nodes": list(range(2000))}],
                meshes=[{"primitives": [primitive] * 2000}])
    yield case("many-uses", uses)
    materials = [{"name": "m%d" % k} for k in range(30000)]
    primitives = [{"attributes": {"POSITION": 0}, "indices": 1, "material": k} for k in range(30000)]
    yield case("many-materials", gltf(materials=materials, meshes=[{"primitives": primitives}]), codes=())
    for name, uri in {"parent": "../canary/precious.txt", "percent": "%2e%2e/canary/precious.txt", "file": "file:///etc/passwd",
                      "http": "http://localhost/a.bin", "bad-percent": "%zz", "bad-base64": "data:;base64,@@@@",
                      "absolute": "/etc/passwd", "nul": "triangle.bin\u0000x", "huge": "a" * 1000000}.items():
        yield case("uri-" + name, gltf(buffers=[{"byteLength": 42, "uri": uri}]), quick=name == "percent")
    for name, sparse in {"unsorted": (2, [2, 1]), "outside": (1, [9]), "many": (5, [0, 1, 2, 3, 4])}.items():
        count, _ = sparse
        yield case("sparse-" + name, gltf(accessors=[{**position, "sparse": {
            "count": count, "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 0}}}, index]),
            codes=())
    whole = files.glb({**files.GLTF, "buffers": [{"byteLength": 42}]})
    for name, data in {"length": whole[:8] + b"\xff\xff\xff\x7f" + whole[12:], "chunk": whole[:12] + b"\xff\xff\xff\xff" + whole[16:],
                       "version": whole[:4] + b"\x09\0\0\0" + whole[8:], "head": whole[:15], "no-json": whole[:16] + b"BIN\0" + whole[20:],
                       "no-binary": files.glb(files.GLTF, b"")[:-8]}.items():
        yield Case("glb-" + name, ["check", "{in}/mesh.glb"], put("mesh.glb", data), exit_codes=())
    nan = struct.pack("<9f3H", float("nan"), 0, 0, .04, 0, 0, 0, .07, 0, 0, 1, 2)
    yield Case("gltf-nan", ["check", "{in}/mesh.gltf"], put("triangle.bin", nan), exit_codes=(1,))


def meshes():
    def comb(corners, inward, times):
        points, faces = files.polygon(corners, inward)
        return "\n".join(points + faces * times) + "\n"

    def stairs(times):
        points = files.spiral(4096)
        face = "f " + " ".join(str(k + 1) for k in range(len(points))) + "\n"
        return "".join("v %.5f %.5f 0\n" % p for p in points) + face * times
    for name, text in {"star": comb(4096, True, 1), "stars": comb(4096, True, 150), "rounds": comb(4096, False, 150),
                       "spirals": stairs(150), "line": "".join("v %d 0 0\n" % k for k in range(4096)) + (
                           "f " + " ".join(str(k + 1) for k in range(4096)) + "\n") * 150,
                       "one-point": "v 0 0 0\n" + ("f " + "1 " * 4096 + "\n") * 150,
                       "corners": comb(5000, False, 1), "long-name": "o " + "a" * 1000000 + "\n" + files.TETRA_OBJ,
                       "names": "".join("o p%d\nusemtl m%d\nf 1 2 3\n" % (k, k) for k in range(3000)) + files.TETRA_OBJ,
                       "far": "v 1e300 0 0\nv 0 1e300 0\nv 0 0 1e300\nf 1 2 3\n", "1e999": "v 1e999 0 0\n",
                       "no-faces": "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "lines": "v 0 0 0\nv 1 0 0\nl 1 2\n"}.items():
        yield Case("obj-" + name, ["check", "{in}/tetra.obj"], put("tetra.obj", text), quick=name in ("stars", "star"))


def views():
    """Lenses that spread the product over more pixels than there are."""
    for name, change in {
            "focal-limit": {"matrix": [1e6, 0, 24, 0, 1e6, 16, 0, 0, 1]},
            "focal-past": {"matrix": [3.67e6, 0, 24, 0, 3.67e6, 16, 0, 0, 1]},
            "focal-least": {"matrix": [0.1, 0, 24, 0, 0.1, 16, 0, 0, 1]},
            "pincushion": {"distortion": [1e6, 0, 0, 0, 0]}, "barrel": {"distortion": [-1e6, 0, 0, 0, 0]},
            "k2": {"distortion": [0, 1e6, 0, 0, 0]}, "k2-minus": {"distortion": [0, -1e6, 0, 0, 0]},
            "k3": {"distortion": [0, 0, 0, 0, 1e6]}, "tangential": {"distortion": [0, 0, 1e6, -1e6, 0]},
            "all": {"distortion": [1e6, -1e6, 1e6, -1e6, 1e6]}, "past": {"distortion": [1e12, 0, 0, 0, 0]},
            "inside": {"translation_mm": [0, 0, 0]}, "touching": {"translation_mm": [0, -1e-12, 1e-12]},
            "far": {"translation_mm": [0, 0, 1e9]}, "shift": {"matrix": [120, 0, 1e6, 0, 120, -1e6, 0, 0, 1]},
            "wide": {"width": 65536, "height": 1}, "huge": {"width": 65536, "height": 65536}}.items():
        for product in ("{in}/tetra.obj", "car"):
            use = [product if word == "{in}/tetra.obj" else word for word in DRAW]
            yield Case("view-%s-%s" % (name, "car" if product == "car" else "tetra"), use,
                       put("camera.json", dump({**files.CAMERA, **change})), cpu_s=10 if product != "car" else 30,
                       quick=name in ("focal-past", "past", "pincushion") and product != "car")


def eyes():
    for name, eye in {"inside": "0,0,0", "far": "1e9,1e9,1e9", "past": "1e20,0,0", "1e999": "1e999,0,0", "nan": "nan,0,0",
                      "on-it": "-40,0,-40"}.items():
        yield Case("eye-" + name, DRAW + ["--eye", eye], make_out, quick=name == "past")


def sessions():
    for name, statements in files.crafted_sessions().items():
        def change(inputs, place, statements=statements):
            make_out(inputs, place)
            files.write_session(inputs / "show.livery", statements)
        may = ("in/show.livery", "in/show.livery-wal", "in/show.livery-shm")
        for use in (["check", "{in}/show.livery"], ["session", "show", "{in}/show.livery"],
                    ["session", "undo", "{in}/show.livery"]):
            yield Case("session-%s-%s" % (name, use[-2] if use[0] == "session" else use[0]), use, change,
                       quick=name in ("view-sum", "generated"), exit_codes=(1, 2), may_change=may)

    def linked_journal(inputs, place):
        session(inputs, place)
        target = str(place / "canary/precious.txt").encode()
        tail = struct.pack(">I", 1) + target + struct.pack(">II", len(target), sum(target)) + bytes.fromhex("d9d505f920a163d7")
        head = bytes.fromhex("d9d505f920a163d7") + struct.pack(">5I", 0, 7, 1, 512, 4096)
        (inputs / "show.livery-journal").write_bytes(head + b"\0" * (512 - len(head)) + tail)
    yield Case("session-journal-deletes", ["session", "undo", "{in}/show.livery"], linked_journal, quick=True,
               may_change=("in/show.livery", "in/show.livery-wal", "in/show.livery-shm"), exit_codes=(2,))


def messages():
    big = "a" * 100000
    for name, arguments in {
            "command": [big], "option": ["render", "--" + big], "value": ["render", "--quality", big, "--out", "a.png"],
            "number": ["render", "--budget-ms", big, "--out", "a.png"], "product": ["plan", "--product", big],
            "look": ["plan", "--look", big], "material": ["albedo", "--material", big, "--mu", "1"],
            "check": ["check", big], "eye": ["plan", "--eye", big], "help": ["help", big], "bench": [
                "photograph", "--bench", big, "--patterns", "{in}/patterns", "--out", "{out}"],
            "near": ["paints", "--near", big], "size": ["patterns", "--projector", big, "--out", "{out}"]}.items():
        yield Case("message-" + name, arguments, quick=name in ("command", "look"), exit_codes=(1, 2))
    for k, text in enumerate(("{", "[]", "7", '"a"', "null", "", "\0", "{}", '{"a":1e999}', '{"captures":{}}',
                              '{"captures":[]}', '{"captures":[null]}', '{"captures":7}', '{"captures":[{}]}')):
        for folder in ("captures", "patterns"):
            yield Case("manifest-%d-%s" % (k, folder), ["check", "{in}/" + folder], put(folder + "/manifest.json", text),
                       quick=text == "{}", exit_codes=(1,))
    yield Case("exr-xyz-photograph", ["check", "{in}/captures"],
               lambda inputs, place: (put("captures/a.exr", files.exr(("X", "Y", "Z"), 32, 24))(inputs, place),
                                      put("captures/manifest.json", dump(replaced(
                                          files.CAPTURES, ("captures", 0, "file"), "a.exr")))(inputs, place)),
               quick=True, exit_codes=(1,), says="X, Y, Z")
    yield Case("exr-xyz-environment", ["check", "{in}/look.json"],
               lambda inputs, place: (put("sky.exr", files.exr(("X", "Y", "Z")))(inputs, place), put(
                   "look.json", dump(replaced(files.LOOK, ("environment", "file"), "sky.exr")))(inputs, place)),
               exit_codes=(1,), says="X, Y, Z")


def cases():
    found = []
    for group in (numbers, nesting, paths, sizes, gltfs, meshes, views, eyes, sessions, messages):
        found.extend(group())
    assert len({case.name for case in found}) == len(found)
    return found
