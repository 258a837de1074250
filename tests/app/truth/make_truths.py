"""Renders the truths of this folder with Cycles, an independent path tracer:

    blender -b -P tests/app/truth/make_truths.py -- tests/app/truth [SCENE_ENVIRONMENT ...]

Writes each scene as SCENE.glb, the environments as ENVIRONMENT.exr, what `toile render` needs as
SCENE_ENVIRONMENT.yaml, and the truth as SCENE_ENVIRONMENT.truth.exr. Blender 3.4.1 and python3-numpy (Debian 12). Takes
about six minutes of CPU time. The mesh of the scene `drape` is not ours; it is there already:

    toile export --garment ../shared/data/garments/diffcloth_dress-handsup-drape.obj -o tests/app/truth/drape.glb

Everything is made here by formulas. Toile's axes: y up, the eye of yaw 0 on +z. Blender's: z up.
"""
import json
import math
import os
import struct
import sys

import bpy
import numpy

SIDE = 128  # pixels
SAMPLES = 1024  # of a pixel; the noise of a mean of 8 x 8 pixels is 0.1 to 0.3 %
BOUNCES = 4  # as reference.bounces
FIELD_OF_VIEW = 30  # degrees

MATT = {"colour": (0.8, 0.8, 0.8), "roughness": None}
RED = {"colour": (0.8, 0.1, 0.1), "roughness": None}
METAL = {"colour": (1, 1, 1), "roughness": 0.5, "metal": 1}  # GGX, alpha .25
PLASTIC = {"colour": (0.7, 0.5, 0.2), "roughness": 0.4, "metal": 0}  # glTF's dielectric, Cycles' principled BSDF


def grid(point, normal, across, down, material):
    """A sheet of across x down quads over the unit square."""
    u, v = numpy.meshgrid(numpy.linspace(0, 1, across + 1), numpy.linspace(0, 1, down + 1))
    u, v = u.ravel(), v.ravel()
    i = numpy.arange(across * down)
    i = i // across * (across + 1) + i % across
    quads = numpy.stack([i, i + 1, i + across + 2, i, i + across + 2, i + across + 1], axis=1)
    normals = numpy.stack(normal(u, v), axis=1)
    return {
        "positions": numpy.stack(point(u, v), axis=1).astype("<f4"),
        "normals": (normals / numpy.linalg.norm(normals, axis=1)[:, None]).astype("<f4"),
        "triangles": quads.reshape(-1, 3).astype("<u2"),
        "material": material,
    }


def plane(corner, along_u, along_v, across, down, material):
    corner, along_u, along_v = map(numpy.array, (corner, along_u, along_v))
    n = numpy.cross(along_u, along_v)
    return grid(
        lambda u, v: [corner[k] + u * along_u[k] + v * along_v[k] for k in range(3)],
        lambda u, v: [u * 0 + n[k] for k in range(3)],
        across, down, material)


def cube(material):
    """Edges are hard: each face has vertices of its own. Stands on a plate, turned by 30 degrees."""
    side, c, s = 0.3, math.cos(math.radians(30)), math.sin(math.radians(30))
    x, y, z = numpy.array([c, 0, -s]), numpy.array([0, 1, 0]), numpy.array([s, 0, c])
    centre = numpy.array([0, side / 2 + 0.001, 0])
    faces = []
    for a, b in ((x, y), (y, x), (y, z), (z, y), (z, x), (x, z)):
        n = numpy.cross(a, b)
        faces.append(plane(centre + side / 2 * (n - a - b), side * a, side * b, 16, 16, material))
    plate = plane([-0.4, 0, 0.4], [0.8, 0, 0], [0, 0, -0.8], 48, 48, MATT)
    return faces + [plate]


def fold(material):
    """Deep pleats beside a red wall."""
    width, height, pleats, depth = 0.8, 0.6, 5, 0.07
    turn = 2 * math.pi * pleats
    sheet = grid(
        lambda u, v: [width * (u - 0.5), height * v, depth * numpy.sin(turn * u)],
        lambda u, v: [-depth * turn / width * numpy.cos(turn * u), u * 0, u * 0 + 1],
        320, 16, material)
    wall = plane([0.42, 0, 0.35], [0, 0, -0.5], [0, height, 0], 32, 32, RED)
    return [sheet, wall]


SCENES = {
    "cube_matt": (cube(MATT), (30, 25, 1.5, (0, 0.12, 0))),
    "cube_metal": (cube(METAL), (30, 25, 1.5, (0, 0.12, 0))),
    "fold_matt": (fold(MATT), (-25, 10, 1.7, (0, 0.3, 0))),
    "fold_metal": (fold(METAL), (-25, 10, 1.7, (0, 0.3, 0))),
    "fold_plastic": (fold(PLASTIC), (-25, 10, 1.7, (0, 0.3, 0))),
    "drape": (None, (20, 20, 1.5, (0.6, 0.98, 0))),
}


def direction(height):
    """Unit directions of the texels' centres: u = .5 + atan2(x, -z)/2pi, v = acos(y)/pi."""
    v, u = numpy.meshgrid((numpy.arange(height) + 0.5) / height, (numpy.arange(2 * height) + 0.5) / (2 * height),
                          indexing="ij")
    angle, polar = 2 * math.pi * (u - 0.5), math.pi * v
    return numpy.stack([numpy.sin(polar) * numpy.sin(angle), numpy.cos(polar), -numpy.sin(polar) * numpy.cos(angle)],
                       axis=2)


def box(d, towards, half_angle, radiance):
    towards = numpy.array(towards) / numpy.linalg.norm(towards)
    return (d @ towards > math.cos(math.radians(half_angle)))[:, :, None] * numpy.array(radiance)


def environments():
    d = direction(32)
    studio = 0.15 + box(d, [1, 0.8, 0.6], 22, [6, 5.6, 5]) + box(d, [-1, 0.3, 0.4], 14, [2, 2.5, 4])
    studio = studio + box(d, [-0.2, 0.6, -1], 10, [9, 9, 9])
    d = direction(64)
    sky = numpy.where(d[:, :, 1:2] > 0, [0.35, 0.5, 0.8], [0.12, 0.11, 0.1])
    sun = sky + box(d, [0.7, 0.9, 0.8], 2.5, [330, 300, 260])
    return {"studio": studio, "sun": sun}


def write_image(path, rgb):
    """Linear float EXR; rows from the top."""
    height, width = rgb.shape[:2]
    image = bpy.data.images.new("image", width, height, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    rgba = numpy.concatenate([rgb[::-1], numpy.ones((height, width, 1))], axis=2)
    image.pixels.foreach_set(rgba.astype(numpy.float32).ravel())
    image.filepath_raw, image.file_format = path, "OPEN_EXR"
    image.save()
    return image


def write_glb(path, parts):
    data, views, accessors, primitives, materials = b"", [], [], [], []

    def accessor(array, component, kind, target):
        nonlocal data
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes, "target": target})
        entry = {"bufferView": len(views) - 1, "componentType": component, "count": array.size // {"SCALAR": 1, "VEC3": 3}[kind],
                 "type": kind}
        if kind == "VEC3":
            entry["min"], entry["max"] = array.min(axis=0).tolist(), array.max(axis=0).tolist()
        data += array.tobytes()
        accessors.append(entry)
        return len(accessors) - 1

    for part in parts:
        if part["material"] not in materials:
            materials.append(part["material"])
        primitives.append({
            "attributes": {"POSITION": accessor(part["positions"], 5126, "VEC3", 34962),
                           "NORMAL": accessor(part["normals"], 5126, "VEC3", 34962)},
            "indices": accessor(part["triangles"].ravel(), 5123, "SCALAR", 34963),
            "material": materials.index(part["material"])})
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": primitives}], "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": len(data)}], "extensionsUsed": ["KHR_materials_specular"],
        "materials": [{
            "doubleSided": True,
            "pbrMetallicRoughness": {"baseColorFactor": [*m["colour"], 1], "metallicFactor": m.get("metal", 0),
                                     "roughnessFactor": m["roughness"] or 1},
            **({} if m["roughness"] else {"extensions": {"KHR_materials_specular": {"specularFactor": 0}}}),
        } for m in materials]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data)


def blender_axes(p):
    return numpy.stack([p[..., 0], -p[..., 2], p[..., 1]], axis=-1)


def build_material(description):
    material = bpy.data.materials.new("material")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    kind = {None: "BsdfDiffuse", 1: "BsdfGlossy", 0: "BsdfPrincipled"}[description.get("metal")]
    lobe = nodes.new("ShaderNode" + kind)
    lobe.inputs["Base Color" if kind == "BsdfPrincipled" else "Color"].default_value = (*description["colour"], 1)
    lobe.inputs["Roughness"].default_value = description["roughness"] or 0
    if kind != "BsdfDiffuse":
        lobe.distribution = "GGX"
    material.node_tree.links.new(lobe.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs[0])
    return material


def build_parts(parts):
    for part in parts:
        mesh = bpy.data.meshes.new("part")
        mesh.from_pydata(blender_axes(part["positions"]).tolist(), [], part["triangles"].tolist())
        for polygon in mesh.polygons:
            polygon.use_smooth = True
        mesh.use_auto_smooth = True
        mesh.normals_split_custom_set_from_vertices(blender_axes(part["normals"]).tolist())
        mesh.materials.append(build_material(part["material"]))
        bpy.context.collection.objects.link(bpy.data.objects.new("part", mesh))


def build_file(path):
    """All of a file in one matt white."""
    numpy.bool = bool  # Blender 3.4.1 asks for a name that Debian 12's numpy no longer has.
    bpy.ops.import_scene.gltf(filepath=path)
    for item in bpy.context.scene.objects:
        if item.type == "MESH":
            item.data.materials.clear()
            item.data.materials.append(build_material(MATT))


def build_camera(yaw, pitch, distance, target):
    yaw, pitch, target = math.radians(yaw), math.radians(pitch), numpy.array(target)
    back = numpy.array([math.sin(yaw) * math.cos(pitch), math.sin(pitch), math.cos(yaw) * math.cos(pitch)])
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.angle = "VERTICAL", math.radians(FIELD_OF_VIEW)
    holder = bpy.data.objects.new("camera", camera)
    holder.location = blender_axes(target + distance * back)
    # Blender's camera looks along its -z, with y up.
    holder.rotation_euler = (math.pi / 2 - pitch, 0, yaw)
    bpy.context.collection.objects.link(holder)
    bpy.context.scene.camera = holder


def build_world(rgb):
    """Blender's u is toile's less a quarter."""
    image = write_image(os.path.join(bpy.app.tempdir, "world.exr"), numpy.roll(rgb, -rgb.shape[1] // 4, axis=1))
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    node = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    node.image, node.interpolation = image, "Closest"
    world.node_tree.links.new(node.outputs[0], world.node_tree.nodes["Background"].inputs[0])
    world.cycles.sampling_method, world.cycles.sample_map_resolution = "MANUAL", 2 * rgb.shape[1]
    bpy.context.scene.world = world


def render(path):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = SIDE
    scene.render.resolution_percentage = 100
    scene.render.film_transparent = True
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "16"
    scene.render.image_settings.exr_codec = "ZIP"
    scene.render.filepath = path
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", SAMPLES, False, False
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = BOUNCES
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy, cycles.light_sampling_threshold = 0, 0
    cycles.caustics_reflective = True
    bpy.ops.render.render(write_still=True)


def write_yaml(path, name, environment, camera, is_made_here):
    yaw, pitch, distance, target = camera
    with open(path, "w") as file:
        file.write(f"""# Written by make_truths.py.
scene: {{garment: {name}.glb, avatar: none, drape: authored, environment: {environment}.exr, environment_yaw_deg: 0}}
camera: {{yaw_deg: {yaw}, pitch_deg: {pitch}, distance_m: {distance}, target: {list(target)}, fov_deg: {FIELD_OF_VIEW}}}
image: {{width: {SIDE}, height: {SIDE}, ground: false}}
""")
        if not is_made_here:
            file.write(f"material: {{use_file: false, diffuse: {list(MATT['colour'])}, specular: [0, 0, 0]}}\n")


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:]
    folder, wanted = arguments[0], arguments[1:]
    for environment, rgb in environments().items():
        write_image(os.path.join(folder, environment + ".exr"), rgb)
        for name, (parts, camera) in SCENES.items():
            both = f"{name}_{environment}"
            if wanted and both not in wanted:
                continue
            bpy.ops.wm.read_factory_settings(use_empty=True)
            mesh = os.path.join(folder, name + ".glb")
            write_yaml(os.path.join(folder, both + ".yaml"), name, environment, camera, parts is not None)
            if parts:
                write_glb(mesh, parts)
                build_parts(parts)
            else:
                build_file(mesh)
            build_camera(*camera)
            build_world(rgb)
            render(os.path.join(folder, both + ".truth.exr"))


main()
