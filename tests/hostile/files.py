"""Files that mean harm, and the smallest good ones that they are made from."""
import functools
import json
import os
import pathlib
import sqlite3
import struct
import zlib

# What may stand where a number is expected.
NUMBERS = ["1e308", "-1e308", "1e20", "1e155", "1e-320", "0", "-1", "1e999", "123456789012345678901234567890",
           "4294967296", "null", '"7"', "[[]]", "true"]


class Raw(str):
    """Goes into JSON as it is."""


def dump(value):
    """json.dumps that lets Raw through."""
    marks = {}

    def marked(v):
        if isinstance(v, Raw):
            marks["@%d@" % len(marks)] = str(v)
            return list(marks)[-1]
        if isinstance(v, dict):
            return {k: marked(x) for k, x in v.items()}
        if isinstance(v, list):
            return [marked(x) for x in v]
        return v

    text = json.dumps(marked(value))
    for mark, raw in marks.items():
        text = text.replace('"%s"' % mark, raw)
    return text


def leaves(value, path=()):
    """Every place in a JSON value that holds no other."""
    if isinstance(value, dict):
        for k, v in value.items():
            yield from leaves(v, path + (k,))
    elif isinstance(value, list) and value:
        for k, v in enumerate(value):
            yield from leaves(v, path + (k,))
    else:
        yield path


def at(value, path):
    for k in path:
        value = value[k]
    return value


def replaced(value, path, new):
    """A copy with another value at a place."""
    if not path:
        return new
    copy = dict(value) if isinstance(value, dict) else list(value)
    copy[path[0]] = replaced(value[path[0]], path[1:], new)
    return copy


# ---- Good ones, small.
CAMERA = {"format_version": 1, "width": 48, "height": 32, "matrix": [120, 0, 24, 0, 120, 16, 0, 0, 1],
          "distortion": [-0.05, 0.02, 0.001, 0, 0], "rotation": [1, 0, 0, 0, -1, 0, 0, 0, -1],
          "translation_mm": [0, 40, 400]}
LOOK = {"format_version": 1, "name": "a", "parts": {"*": "solid red"},
        "lights": [{"type": "directional", "direction": [0.3, 1, 0.4], "radiance": [1, 1, 1], "angle_rad": 0.05}],
        "environment": {"file": "sky.hdr", "rotation_rad": 0.5, "scale": 1},
        "artwork": [{"part": "*", "shape": "stripes", "paint": "solid red", "size_mm": 20, "share": 0.5,
                     "place": {"centre_mm": [0, 0, 0], "direction": [0, 0, -1], "up": [0, 1, 0]}}],
        "exposure_ev": 0}
PICTURE_LOOK = {**LOOK, "artwork": [{"part": "*", "shape": "picture", "picture": "dot.png", "size_mm": 20,
                                     "place": {"centre_mm": [0, 0, 0], "direction": [0, 0, -1], "up": [0, 1, 0]}}]}
MATERIAL = {"format_version": 1, "name": "p", "model": "car-paint", "parameters": {
    "diffuse": [0.1, 0.1, 0.2], "f0": [0.04, 0.04, 0.04], "alpha": 0.3, "flake_f0": [0.3, 0.3, 0.3],
    "flake_alpha": 0.1, "coat_alpha": 0.02, "coat_f0": 0.04, "coat_transmittance": [1, 1, 1],
    "film_nm": 200, "film_eta": 1.5}}
MEASURED_MATERIAL = {"format_version": 1, "name": "m", "model": "measured", "parameters": {"file": "nine.csv"}}
PRODUCT = {"format_version": 1, "name": "P", "mesh": "tetra.obj", "unit": "mm", "product_scale": 1,
           "pose": {"rotation": [1, 0, 0, 0, 1, 0, 0, 0, 1], "translation_mm": [0, 0, 0]}, "parts": []}
BENCH = {"format_version": 1, "kind": "bench", "base": "default.json", "name": "b", "product": "tetra.obj",
         "eye_mm": [0, 100, 400],
         "projector": {"width": 32, "height": 24, "matrix": [60, 0, 16, 0, 60, 12, 0, 0, 1],
                       "distortion": [0, 0, 0, 0, 0], "gamma": [2.2, 2.2, 2.2], "s_curve": 0.1,
                       "from_mm": [20, 90, 400], "at_mm": [0, 26, 0], "at_px": [16, 12]},
         "camera": {"width": 48, "height": 32, "matrix": [90, 0, 24, 0, 90, 16, 0, 0, 1],
                    "distortion": [0, 0, 0, 0, 0], "from_mm": [60, 90, 390], "at_mm": [0, 26, 0],
                    "at_px": [24, 16], "black_level_units": 1024, "electrons_per_unit": 10}}
PATTERNS = {"format_version": 1, "projector": [32, 24], "captures": [
    {"file": "000.png", "pattern": "000.png", "role": "white", "drive": [255, 255, 255], "exposure_s": None},
    {"file": "001.png", "pattern": "001.png", "role": "black", "drive": [0, 0, 0], "exposure_s": None}]}
CAPTURES = {"format_version": 1, "projector": [32, 24], "captures": [
    {"file": "000.png", "pattern": "000.png", "role": "white", "drive": [255, 255, 255], "exposure_s": 0.1,
     "transfer": "response.json", "black_level": 3, "saturates_at": 250},
    {"file": "001.png", "pattern": "001.png", "role": "black", "drive": 0, "exposure_s": 0.1}]}
SPHERE = {"format_version": 1, "transfer": "srgb", "camera": "camera.json", "camera_to_xyz": "xyz.json",
          "sphere": {"centre_mm": [0, 0, 0], "diameter_mm": 60},
          "white_reference": {"reflectance": [0.9, 0.9, 0.8], "file": "001.png", "exposure_s": 0.5,
                              "light_position_mm": [0, 90, 300]},
          "captures": [{"file": "000.png", "exposure_s": 0.1, "black_level": 3, "light_position_mm": [40, 0, 300]}]}
BALL = {"format_version": 1, "environment": "ball", "transfer": "srgb", "camera_to_xyz": "xyz.json",
        "sphere": {"centre_mm": [0, 0, 0], "diameter_mm": 60}, "reflectance": [0.6, 0.6, 0.5], "views": [
            {"camera": "camera.json", "mask": "001.png", "outline_px": [[0, 1], [1, 2], [3, 4], [5, 5], [2, 9]],
             "fit_outline": False, "captures": [{"file": "000.png", "exposure_s": 0.1, "black_level": 3}]}]}
SPOT = {"format_version": 1, "transfer": "srgb", "camera": "camera.json", "exposure_s": 0.1,
        "plane": {"point_mm": [0, 0, 0], "normal": [0, 0.1, 1]}, "projector_mm": [100, 0, 900],
        "captures": [{"file": "000.png", "black_level": 3}], "black": [{"file": "001.png"}],
        "white_reference": {"reflectance": [0.9, 0.9, 0.8], "captures": [{"file": "000.png"}],
                            "black": [{"file": "001.png", "exposure_s": 0.5}]}}
XYZ = {"format_version": 1, "matrix": [0.4, 0.3, 0.2, 0.2, 0.7, 0.1, 0, 0.1, 0.9]}
PRIMARIES = {"format_version": 1, "measured_at_px": [10, 20], "primaries_xyz": {
    "red": [4, 2, 0], "green": [3, 7, 1], "blue": [2, 1, 9], "black": [0.1, 0.1, 0.1]}}
RESPONSE = {"format_version": 1, "linear_from_file": [0, 0.02, 0.2, 0.5, 1]}
TETRA_OBJ = ("v -40 0 -40\nv 40 0 -40\nv 0 0 40\nv 0 70 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n")
TRIANGLE = struct.pack("<9f3H", -.04, 0, 0, .04, 0, 0, 0, .07, 0, 0, 1, 2)
GLTF = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "scale": [1, 1, 1], "rotation": [0, 0, 0, 1], "translation": [0, 0, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1], "roughnessFactor": 0.5}}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36},
                        {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
        "buffers": [{"byteLength": 42, "uri": "triangle.bin"}]}
PLY = ("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
       "element face 4\nproperty list uchar int vertex_indices\nend_header\n-40 0 -40\n40 0 -40\n0 0 40\n0 70 0\n"
       "3 0 1 2\n3 0 3 1\n3 1 3 2\n3 2 3 0\n")
DIRECTIONS = "theta_i,phi_i,theta_o,phi_o\n0.1,0,0.5,3.1\n1.5,6.28,1e-3,-2\n"
NINE = DIRECTIONS.split("\n")[0] + ",r,g,b\n" + "".join(
    "%g,0,%g,%g,0.1,0.2,0.3\n" % (0.1 * k, 0.3 + 0.1 * k, 0.7 * k) for k in range(9))


def png(width=32, height=24, declared=None, grey=128):
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    rows = (b"\0" + bytes([grey]) * (3 * width)) * height
    size = struct.pack(">2I5B", *(declared or (width, height)), 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", size) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def exr(channels=("B", "G", "R"), width=32, height=16, declared=None, filled=True, value=0x3c00):
    """Half floats, deflated by sixteen rows."""
    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data

    w, h = declared or (width, height)
    names = b"".join(c.encode() + b"\0" + struct.pack("<iiii", 1, 0, 1, 1) for c in channels) + b"\0"
    window = struct.pack("<4i", 0, 0, w - 1, h - 1)
    header = (b"\x76\x2f\x31\x01" + struct.pack("<i", 2) + attribute(b"channels", b"chlist", names) +
              attribute(b"compression", b"compression", b"\x03") + attribute(b"dataWindow", b"box2i", window) +
              attribute(b"displayWindow", b"box2i", window) + attribute(b"lineOrder", b"lineOrder", b"\0") +
              attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)) +
              attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)) +
              attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0")
    if not filled:
        return header + b"\0" * 64
    blocks, table = b"", b""
    count = (h + 15) // 16
    packed = {}
    for k in range(count):
        rows = min(16, h - 16 * k)
        if rows not in packed:
            data = struct.pack("<H", value) * (w * rows * len(channels))
            half = data[0::2] + data[1::2]
            delta = half[:1] + bytes((half[i] - half[i - 1] + 128) & 255 for i in range(1, min(len(half), 1 << 16)))
            if len(half) > 1 << 16:  # constant but for one step in the middle
                middle = (len(half) + 1) // 2
                step = (half[middle] - half[middle - 1] + 128) & 255
                delta = half[:1] + b"\x80" * (middle - 1) + bytes([step]) + b"\x80" * (len(half) - middle - 1)
            packed[rows] = zlib.compress(delta, 9)
        table += struct.pack("<Q", len(header) + 8 * count + len(blocks))
        blocks += struct.pack("<ii", 16 * k, len(packed[rows])) + packed[rows]
    return header + table + blocks


def hdr(width=32, height=16, declared=None):
    w, h = declared or (width, height)
    text = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (h, w)
    return text + b"\x80\x80\x80\x80" * (width * height)


def glb(value, binary=TRIANGLE):
    text = dump(value).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


@functools.lru_cache(None)
def good_files():
    """One good file of each kind, by name."""
    made = {name: dump(value).encode() for name, value in {
        "camera.json": CAMERA, "look.json": LOOK, "picture-look.json": PICTURE_LOOK, "material.json": MATERIAL,
        "measured-material.json": MEASURED_MATERIAL, "product.json": PRODUCT, "bench.json": BENCH, "xyz.json": XYZ,
        "primaries.json": PRIMARIES, "response.json": RESPONSE, "mesh.gltf": GLTF}.items()}
    made |= {name: text.encode() for name, text in {
        "tetra.obj": TETRA_OBJ, "tetra.ply": PLY, "dirs.csv": DIRECTIONS, "nine.csv": NINE}.items()}
    made |= {"triangle.bin": TRIANGLE, "000.png": png(), "001.png": png(grey=0), "dot.png": png(8, 8), "sky.hdr": hdr(),
             "sky.exr": exr(), "mesh.glb": glb({**GLTF, "buffers": [{"byteLength": 42}]}), "map.exr": exr(("X", "Y"))}
    for folder, manifest in {"patterns": PATTERNS, "captures": CAPTURES, "sphere": SPHERE, "ball": BALL, "spot": SPOT}.items():
        made[folder + "/manifest.json"] = dump(manifest).encode()
        for name in ("000.png", "001.png", "response.json", "camera.json", "xyz.json"):
            made[folder + "/" + name] = made[name]
    return made


def good_folder(folder):
    for part in ("patterns", "captures", "sphere", "ball", "spot"):
        (folder / part).mkdir(parents=True)
    for name, data in good_files().items():
        with open(folder / name, "wb") as file:
            file.write(data)


SESSION = b""  # one that the program made
SESSION_SCHEMA = [
    "CREATE TABLE step (number INTEGER PRIMARY KEY, command TEXT NOT NULL, label TEXT NOT NULL, "
    "document TEXT NOT NULL)",
    "CREATE TABLE place (only INTEGER PRIMARY KEY CHECK (only = 1), position INTEGER NOT NULL)",
    "CREATE TABLE workspace (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID"]
ENDLESS = "WITH RECURSIVE c(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM c) SELECT "


def crafted_sessions():
    """Schemas that would run what their maker likes."""
    step, place, workspace = SESSION_SCHEMA
    view = "CREATE VIEW {} AS " + ENDLESS
    return {
        "view-place": [step, workspace, view.format("place") + "1 AS only, n AS position FROM c"],
        "view-step": [place, workspace, view.format("step") +
                      "n AS number, 'x' AS command, 'x' AS label, 'x' AS document FROM c"],
        "view-workspace": [step, place, view.format("workspace") + "n AS name, 'v' AS value FROM c"],
        "view-sum": [step, workspace, view.format("place") + "1 AS only, sum(n) AS position FROM c"],
        "view-beside": [step, place, workspace, view.format("more") + "n FROM c"],
        "trigger-update": [step, place, workspace, "CREATE TRIGGER t BEFORE UPDATE ON place BEGIN "
                           "INSERT INTO step SELECT n, 'x', 'x', zeroblob(1000000) FROM (" + ENDLESS + "n FROM c); END"],
        "trigger-insert": [step, place, workspace, "CREATE TRIGGER t AFTER INSERT ON step BEGIN DELETE FROM place; END"],
        "virtual": [step, workspace, "CREATE VIRTUAL TABLE place USING fts4(only, position)"],
        "generated": [step, place, "CREATE TABLE workspace (name TEXT PRIMARY KEY, value TEXT GENERATED ALWAYS AS "
                      "(hex(zeroblob(20000000))) VIRTUAL)"],
        "check": [step, "CREATE TABLE place (only INTEGER PRIMARY KEY, position INTEGER NOT NULL CHECK "
                  "(length(hex(zeroblob(20000000))) > 0))", workspace],
        "index": [step, place, workspace, "CREATE INDEX i ON step (hex(zeroblob(20000000 + length(label))))"],
        "more-tables": [step, place, workspace] + ["CREATE TABLE t%d (x)" % k for k in range(300)],
    }


def write_session(file, statements):
    file.unlink(missing_ok=True)
    database = sqlite3.connect(file)
    database.execute("PRAGMA application_id = %d" % 0x4c765331)
    for statement in statements:
        try:
            database.execute(statement)
        except sqlite3.OperationalError:
            pass  # a kind of table that this SQLite was built without
    for row in ("INSERT INTO place VALUES (1, 0)", "INSERT INTO step VALUES (0, '', '', '{}')",
                *("INSERT INTO workspace (name) VALUES ('%d')" % k for k in range(60))):
        try:
            database.execute(row)
        except sqlite3.Error:
            pass  # a view in its place
    database.execute("PRAGMA user_version = 1")
    database.commit()
    database.close()


def polygon(corners, inward):
    """An OBJ of one polygon whose corners turn inward half of the time: a comb or a star."""
    import math
    points, faces = [], []
    for k in range(corners):
        a = 2 * math.pi * k / corners
        r = 50 - (20 if inward and k % 2 else 0)
        points.append("v %.6f %.6f 0" % (r * math.cos(a), r * math.sin(a)))
    faces.append("f " + " ".join(str(k + 1) for k in range(corners)))
    return points, faces


def make_fifo(path):
    if not path.exists():
        os.mkfifo(path)


def spiral(corners):
    import math
    half = corners // 2
    points = []
    for k in range(half):
        a = 0.05 * k
        points.append((a * math.cos(a), a * math.sin(a)))
    for k in range(half):
        a = 0.05 * (half - 1 - k)
        points.append(((a + 1) * math.cos(a), (a + 1) * math.sin(a)))
    return points


def folder_of(path):
    return pathlib.Path(path).parent
