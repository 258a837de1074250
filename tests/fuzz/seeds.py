"""Writes the seeds of `./dev fuzz`: one small file at least for every form that a reader knows.

usage: python3 seeds.py CORPUS FORMAT_FILES TOILE
The two programs are the tests' writer of packed glTF files, and toile itself, which writes the OpenEXR files.
"""
import base64, json, os, struct, subprocess, sys, tempfile, zipfile, zlib

corpus, format_files, toile = sys.argv[1], os.path.abspath(sys.argv[2]), os.path.abspath(sys.argv[3])


def put(reader, name, data):
    os.makedirs(f"{corpus}/{reader}", exist_ok=True)
    with open(f"{corpus}/{reader}/seed_{name}", "wb") as stream:
        stream.write(data.encode() if isinstance(data, str) else data)


# ---- Pictures ----

def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width, height, colour, depth, rows, palette=b"", interlace=0):
    head = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, interlace)
    data = zlib.compress(b"".join(b"\0" + row for row in rows))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + (chunk(b"PLTE", palette) if palette else b"")
            + chunk(b"IDAT", data) + chunk(b"IEND", b""))


def tiff(order, tags, strip):
    """One directory; tags are (number, type, values)."""
    mark = {"<": b"II", ">": b"MM"}[order]
    entries, extra = b"", b""
    tags = sorted(tags + [(273, 4, [0])])
    base = 8 + 2 + 12 * len(tags) + 4
    for number, kind, values in tags:
        size = {3: 2, 4: 4}[kind]
        data = b"".join(struct.pack(order + {2: "H", 4: "I"}[size], value) for value in values)
        if number == 273:
            data = b"STRP"
        if len(data) <= 4:
            entries += struct.pack(order + "HHI", number, kind, len(values)) + data.ljust(4, b"\0")
        else:
            entries += struct.pack(order + "HHII", number, kind, len(values), base + len(extra))
            extra += data
    entries = entries.replace(b"STRP", struct.pack(order + "I", base + len(extra)))
    return (mark + struct.pack(order + "HI", 42, 8) + struct.pack(order + "H", len(tags)) + entries
            + struct.pack(order + "I", 0) + extra + strip)


def jpeg():
    """A grey block of 8 x 8 texels: one coefficient, with Huffman tables of one code each."""
    def segment(mark, data):
        return b"\xff" + bytes([mark]) + struct.pack(">H", len(data) + 2) + data
    table = bytes([1] + [0] * 15)
    return (b"\xff\xd8" + segment(0xDB, b"\0" + bytes([16] * 64))
            + segment(0xC0, struct.pack(">BHHB", 8, 8, 8, 1) + bytes([1, 0x11, 0]))
            + segment(0xC4, b"\x00" + table + b"\0") + segment(0xC4, b"\x10" + table + b"\0")
            + segment(0xDA, bytes([1, 1, 0, 0, 63, 0])) + b"\x3f" + b"\xff\xd9")


dot = png(2, 2, 2, 8, [bytes([10, 20, 30, 200, 100, 50]), bytes([0, 0, 0, 255, 255, 255])])
put("picture", "rgb.png", dot)
put("picture", "grey16.png", png(2, 1, 0, 16, [bytes([1, 2, 200, 3])]))
put("picture", "rgba.png", png(1, 2, 6, 8, [bytes([1, 2, 3, 4]), bytes([5, 6, 7, 255])]))
put("picture", "indexed.png", png(4, 1, 3, 2, [bytes([0b00011011])], bytes(range(12))))
put("picture", "grey.jpg", jpeg())
plain = [(256, 4, [2]), (257, 4, [2]), (258, 3, [8, 8, 8]), (259, 3, [1]), (262, 3, [2]), (277, 3, [3]),
         (278, 4, [2]), (279, 4, [12])]
put("picture", "rgb.tif", tiff("<", plain, bytes(range(12))))
put("picture", "grey16.tif", tiff(">", [(256, 4, [2]), (257, 4, [1]), (258, 3, [16]), (259, 3, [1]), (262, 3, [1]),
                                        (277, 3, [1]), (278, 4, [1]), (279, 4, [4])], bytes([1, 2, 200, 3])))
deflated = zlib.compress(bytes(range(12)))
put("picture", "deflate.tif", tiff("<", [tag if tag[0] not in (259, 279) else (tag[0], tag[1],
    [8 if tag[0] == 259 else len(deflated)]) for tag in plain], deflated))

put("hdr", "flat.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1\n\n-Y 1 +X 2\n\x80\x40\x20\x81\x20\x40\x80\x80")
row = b"\x02\x02\x00\x08" + b"".join(bytes([0x88, value]) for value in (128, 64, 32, 129))
put("hdr", "runs.hdr", b"#?RADIANCE\n\n-Y 2 +X 8\n" + row + b"\x02\x02\x00\x08" + b"\x08abcdefgh" * 3 + b"\x88\x81")
put("hdr", "turned.hdr", b"#?RGBE\n\n+Y 1 -X 2\n\x80\x40\x20\x81\x20\x40\x80\x80")


def exr(compression, channels, width, height, attributes=b""):
    """Rows of one part, uncompressed or in blocks that are as large as they were; channels are (name, type)."""
    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<I", len(data)) + data
    listing = b"".join(name + b"\0" + struct.pack("<IIII", kind, 0, 1, 1) for name, kind in channels) + b"\0"
    box = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    head = (b"\x76\x2f\x31\x01" + struct.pack("<I", 2) + attribute(b"channels", b"chlist", listing)
            + attribute(b"compression", b"compression", bytes([compression]))
            + attribute(b"dataWindow", b"box2i", box) + attribute(b"displayWindow", b"box2i", box)
            + attribute(b"lineOrder", b"lineOrder", b"\0") + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
            + attribute(b"screenWindowCenter", b"v2f", struct.pack("<ff", 0, 0))
            + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + attributes + b"\0")
    rows, offset = [], len(head) + 8 * height
    for y in range(height):
        data = b"".join((struct.pack("<e", 0.5 + y) if kind == 1 else struct.pack("<f", 0.25 * y)) * width
                        for _, kind in channels)
        rows.append(struct.pack("<iI", y, len(data)) + data)
    table = b""
    for r in rows:
        table += struct.pack("<Q", offset)
        offset += len(r)
    return head + table + b"".join(rows)


put("exr", "half.exr", exr(0, [(b"B", 1), (b"G", 1), (b"R", 1)], 4, 2))
put("exr", "float_alpha.exr", exr(0, [(b"A", 2), (b"B", 2), (b"G", 2), (b"R", 2)], 4, 2))
put("exr", "layer.exr", exr(0, [(b"key.B", 1), (b"key.G", 1), (b"key.R", 1), (b"Z", 2)], 2, 1))
put("exr", "envmap.exr", exr(0, [(b"B", 1), (b"G", 1), (b"R", 1)], 2, 12,
                             b"envmap\0envmap\0" + struct.pack("<I", 1) + b"\1"))
with tempfile.TemporaryDirectory() as folder:
    source, target = f"{folder}/in.hdr", f"{folder}/out.exr"
    with open(source, "wb") as stream:
        stream.write(b"#?RADIANCE\n\n-Y 2 +X 4\n" + bytes([90, 80, 70, 129] * 8))
    subprocess.run([toile, "env", source, "-o", target, "--layout", "latlong", "--size", "2", "--quiet"], check=True)
    put("exr", "zip.exr", open(target, "rb").read())

directions = [(0, 0), (20, 40), (45, 120), (70, 250)]
put("samples", "angles.csv", "# measured\ntheta_l,phi_l,theta_v,phi_v,r,g,b\n" + "".join(
    f"{a},{b},{c},{d},{0.1 + a / 100},{0.2 + c / 100},0.1\n" for a, b in directions for c, d in directions for _ in range(2)))
put("samples", "vectors.txt", "l_x l_y l_z v_x v_y v_z value\n" + "0.6 0 0.8 0 0.6 0.8 1e-1\n" * 16 + "0 0 1 0 -0.6 0.8 0.3\n" * 16)

# ---- Models ----

with tempfile.TemporaryDirectory() as folder:
    subprocess.run([format_files, "write", folder], check=True)
    for name in sorted(os.listdir(folder)):
        put("glb", name, open(f"{folder}/{name}", "rb").read())

positions = struct.pack("<12f", 0, 0, 0, 0.5, 0, 0, 0, 0.5, 0, 0.5, 0.5, 0)
uvs = struct.pack("<8f", 0, 0, 0.5, 0, 0, 0.5, 0.5, 0.5)
indices = struct.pack("<6H", 0, 1, 2, 1, 3, 2)
joints, weights = bytes([0, 0, 0, 0] * 4), struct.pack("<16f", *([1, 0, 0, 0] * 4))
times, turns = struct.pack("<2f", 0, 1), struct.pack("<8f", 0, 0, 0, 1, 0, 0.7071, 0, 0.7071)
parts = [positions, uvs, indices, joints, weights, times, turns]
buffer, views = b"", []
for part in parts:
    views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": len(part)})
    buffer += part


def accessor(view, component, count, kind):
    return {"bufferView": view, "componentType": component, "count": count, "type": kind}


full = {
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"mesh": 0, "skin": 0}, {"name": "joint", "scale": [1, -1, 1], "translation": [0, 0.1, 0]}],
    "skins": [{"joints": [1]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "JOINTS_0": 3, "WEIGHTS_0": 4}, "indices": 2,
                                "material": 0, "extensions": {"KHR_materials_variants": {"mappings": [
                                    {"material": 1, "variants": [0]}]}}}]}],
    "animations": [{"name": "turn", "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}],
                    "samplers": [{"input": 5, "output": 6, "interpolation": "STEP"}]}],
    "materials": [
        {"name": "cotton", "doubleSided": True, "alphaMode": "MASK", "emissiveFactor": [0.1, 0, 0],
         "normalTexture": {"index": 0, "scale": 0.5}, "occlusionTexture": {"index": 0},
         "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {
             "scale": [2, 3], "offset": [0.1, 0], "rotation": 0.3}}}, "metallicRoughnessTexture": {"index": 0}}},
        {"name": "satin", "alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 0.5]},
         "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.8, "anisotropyTexture": {"index": 0}},
                        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5}, "KHR_materials_sheen": {
                            "sheenColorFactor": [1, 1, 1], "sheenRoughnessFactor": 0.4},
                        "KHR_materials_transmission": {"transmissionFactor": 0.3}, "KHR_materials_ior": {"ior": 1.4},
                        "KHR_materials_specular": {"specularFactor": 0.5}}}],
    "textures": [{"source": 0, "sampler": 0}], "samplers": [{"wrapS": 33071}],
    "images": [{"uri": "dot.png"}],
    "extensionsUsed": ["KHR_materials_variants", "KHR_texture_transform", "KHR_materials_anisotropy"],
    "extensions": {"KHR_materials_variants": {"variants": [{"name": "red"}]}},
    "accessors": [accessor(0, 5126, 4, "VEC3"), accessor(1, 5126, 4, "VEC2"), accessor(2, 5123, 6, "SCALAR"),
                  accessor(3, 5121, 4, "VEC4"), accessor(4, 5126, 4, "VEC4"), accessor(5, 5126, 2, "SCALAR"),
                  accessor(6, 5126, 2, "VEC4")],
    "bufferViews": views,
    "buffers": [{"byteLength": len(buffer), "uri": "data:application/octet-stream;base64," + base64.b64encode(buffer).decode()}],
}
put("gltf", "full.gltf", json.dumps(full))
sparse = {"asset": {"version": "2.0"}, "nodes": [{"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}],
          "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5}]}],
          "accessors": [{"componentType": 5126, "count": 4, "type": "VEC3", "sparse": {
              "count": 4, "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 0}}}],
          "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 4}],
          "buffers": [{"byteLength": 52, "uri": "data:application/octet-stream;base64,"
                       + base64.b64encode(positions + bytes([0, 1, 2, 3])).decode()}]}
put("gltf", "sparse.gltf", json.dumps(sparse))

materials = ("newmtl cotton\nKd .5 .4 .3\nKs .1 .1 .1\nNs 20\nillum 2\nd 0.9\nKa 0 0 0\nNi 1\nmap_Kd -s 2 2 -o .1 0 dot.png\n"
             "map_Ks dot.png\nnorm dot.png\nmap_d dot.png\nnewmtl silk\nillum 1\n")
put("obj", "panels.obj", "mtllib input.mtl\no front\ng a b\ns 1\nv 0 0 0\nv .5 0 0\nv .5 .5 0\nv 0 .5 0\nvt 0 0\nvt .5 0\nvt .5 .5\n"
    "vt 0 .5\nvn 0 0 1\nusemtl cotton\nf 1/1/1 2/2/1 3/3/1 4/4/1\nusemtl silk\nf -4 -3 -2\n" + materials)
put("obj", "stitched.obj", "v 0 0 0\nv .5 0 0\nv .5 .5 0\nv 0 .5 0\nv .5 0 .1\nv 1 0 .1\nv 1 .5 .1\nv .5 .5 .1\n"
    "f 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\nstitch 1 4 5 0\nstitch 2 7 4 .1\n")
put("obj", "concave.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv .5 .2 0\nv 0 1 0\nf 1 2 3 \\\n 4 5\n")
square = "0 0 0\n.5 0 0\n.5 .5 0\n0 .5 0\n"
put("ply", "text.ply", "ply\nformat ascii 1.0\ncomment seed\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + square + "4 0 1 2 3\n")
for name, order in (("little", "<"), ("big", ">")):
    put("ply", f"{name}.ply", f"ply\nformat binary_{name}_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n"
        "property list uchar int vertex_indices\nend_header\n".encode()
        + b"".join(struct.pack(order + "fff", *struct.unpack("<3f", positions[12 * i:12 * i + 12])) + bytes([255, 0, 9])
                   for i in range(4))
        + b"".join(b"\3" + struct.pack(order + "iii", *face) for face in ((0, 1, 2), (1, 3, 2))))
facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex .5 0 0\nvertex 0 .5 0\nendloop\nendfacet\n"
put("stl", "text.stl", "solid seed\n" + facet + "endsolid seed\n")
put("stl", "binary.stl", b"binary".ljust(80, b"\0") + struct.pack("<I", 2)
    + struct.pack("<12fH", 0, 0, 1, 0, 0, 0, .5, 0, 0, 0, .5, 0, 0) + struct.pack("<12fH", 0, 0, 1, .5, 0, 0, .5, .5, 0, 0, .5, 0, 0))
put("off", "plain.off", "OFF\n4 1 0\n" + square + "4 0 1 2 3\n")
put("off", "colours.off", "COFF\n4 2 0\n" + square.replace("\n", " 255 0 0 255\n") + "3 0 1 2 .1 .2 .3\n3 0 2 3\n")


def panel(z, **more):
    edges = [{"endpoints": [i, (i + 1) % 4]} for i in range(4)]
    return {"translation": [0, 100, z], "rotation": [0, 0, 0], "vertices": [[0, 0], [30, 0], [30, 40], [0, 40]], "edges": edges, **more}


front, back = panel(20), panel(-20, label="back")
front["edges"][0]["curvature"] = [0.5, 0.1]
front["edges"][1]["curvature"] = {"type": "cubic", "params": [[0.3, 0.05], [0.7, 0.05]]}
front["edges"][2]["curvature"] = {"type": "circle", "params": [30, 0, 1]}
front["edges"][3]["label"] = "hem"
back["edges"][1]["curvature"] = {"type": "quadratic", "params": [[0.5, 0.05]]}
put("pattern", "tube.json", json.dumps({
    "pattern": {"panels": {"front": front, "back": back}, "panel_order": ["front", "back"],
                "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 1}],
                             [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 3}, "right_wrong"]]},
    "properties": {"curvature_coords": "relative", "units_in_meter": 100, "normalized_edge_loops": True}}))

# ---- Motions ----

samples = struct.pack("<18f", *(0.1 * i for i in range(18)))
put("pc2", "two.pc2", b"POINTCACHE2\0" + struct.pack("<iiffi", 1, 3, 0, 1, 2) + samples)
put("mdd", "two.mdd", struct.pack(">ii2f18f", 2, 3, 0, 1 / 24, *(0.1 * i for i in range(18))))

# ---- Text ----

put("scene", "small.yaml", "# comment\nscene:\n  garment: dress\n  fabric: satin\n  preset: draft\n  colourway: Ink\n  move_m: [0, 0.1, 0]\n"
    "camera:\n  yaw_deg: 25\ncolourways:\n  Ink:\n    all: {diffuse: [0.03, 0.05, 0.2]}\n    cotton: {fabric: denim}\n"
    "cloth: {edge_m: 0.02}\nmaterial:\n  use_file: false\n  model: ward\nlight:\n  method: pem\n  regions: 24\nimage:\n  width: 64\n")
put("fabric", "weave.yaml", "fabric:\n  areal_density: 0.1\n  stretch_weft: 543\nweave:\n  pattern: twill\n  warp_pitch_mm: 0.4\n"
    "  warp_tint: [1, 1, 1]\nmaterial:\n  diffuse: [0.5, 0.04, 0.08]\n  glossiness: 0.9\nconstruction:\n  seam: flat_felled\n")
put("fabric", "picture.yaml", "weave:\n  pattern: none\n  picture: dot.png\n")
put("path", "turn.yaml", "keys:\n  - {time_s: 0, yaw_deg: 0, pitch_deg: 5, distance_m: 2.5, target: [0, 1, 0], fov_deg: 30}\n"
    "  - {time_s: 4, yaw_deg: 360, environment_yaw_deg: 90}\n")
put("lights", "near.yaml", "swatch: {width_mm: 40, camera_mm: 600, even: false}\nlamps:\n" + "".join(
    f"  - {{azimuth_deg: {90 * k}, elevation_deg: 45, intensity: 0.9}}\n" for k in range(4)) + "  - {position_mm: [0, 90, 120]}\n")
picture = {"path": "dot.png", "width": 20, "height": 10, "dpi": 300, "repeat": {"mode": "mirror_x", "rotation": 0}}


def number(value, **texture):
    return {"constant": value, "texture": {"factor": 1, "offset": 0, "image": picture, **texture} if texture else None}


surface = {"shader": "principled", "alpha": number(1), "roughness": number(0, factor=0.5), "metalness": number(0.25),
           "clearcoat_value": number(0.2), "ior": number(1.4), "transmission": number(0.1), "displacement": number(0, factor=0.8),
           "basecolor": {"constant": {"r": 1, "g": 1, "b": 1}, "texture": {"mode": "multiply", "image": picture,
                         "factor": {"r": 1, "g": 0.5, "b": 1}}},
           "normal": {"constant": {"x": 0, "y": 0, "z": 1}, "texture": {"image": picture}}}
u3m = json.dumps({"schema": "1.1", "custom": None, "material": {
    "name": "Probe", "side": None, "metadata": None, "front": surface, "back": {"basecolor": number({"r": 0.1, "g": 0.2, "b": 0.3})},
    "physics": {"thickness": 0.4, "weight": 180, "composition": None, "devices": {"fab": "null"},
                "material_type": None, "construction": {"type": "Twill", "name": None}}}})
put("u3m", "probe.u3m", u3m)
archive = tempfile.NamedTemporaryFile()
for name, method in (("deflated", zipfile.ZIP_DEFLATED), ("stored", zipfile.ZIP_STORED)):
    with zipfile.ZipFile(archive.name, "w", method) as target:
        for entry, data in (("probe.u3m", u3m), ("dot.png", dot)):
            target.writestr(zipfile.ZipInfo(entry, (2020, 1, 1, 0, 0, 0)), data, compress_type=method)
    put("u3ma", f"{name}.u3ma", open(archive.name, "rb").read())


def strip(stretch):
    """A specimen of a few steps: stretched (S), bent down (D) and up (U)."""
    def test(tree):
        return {"freq": 55, "length": 8, "width": 5, "testVersion": 15, "samplesTree": tree}
    bent = [[2 - 0.02 * i, -1 - 0.004 * i * i] for i in range(40)]
    return {"S1": test([[8 + 0.02 * i, stretch * i] for i in range(40)]), "S2": test([[8 + 0.02 * i, stretch * i] for i in range(40)]),
            "D1": test(bent), "D2": test(bent), "U1": test([[x, -y] for x, y in bent])}


put("fab", "measured.json", json.dumps({"custom": {"browzwear": {"mass": "105", "thickness": "0.1"}},
                                        "raw_data": {"L": strip(3), "W": strip(2), "B": strip(1)}}))
