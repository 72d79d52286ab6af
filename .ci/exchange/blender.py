"""Tries exported files in Blender: python3 blender.py DIRECTORY

The directory is what prepare.mjs has made. The mesh as it comes must look like our picture; radiosity at vertices, and
the lightmap on its coarse mesh, are rendered without any light of Blender's own and must be the radiance that our
picture holds. One line a scene; exit status 1 if any fails. Needs the module `bpy`, from PyPI for one version of Python only.
"""

import json
import math
import struct
import sys
from pathlib import Path

import bpy
import numpy
from mathutils import Vector

# Most that radiance may differ from our picture, on average, as a share of its mean.
RADIANCE = 0.03

# Most pixels, as a share, that may be more than 4 of 255 from ours.
FAR = 0.01


def must(holds, what):
    if not holds:
        raise AssertionError(what)


def primitives(path):
    data = path.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    document = json.loads(data[20 : 20 + length])
    count = lambda index: document["accessors"][index]["count"]
    return [
        (count(p["attributes"]["POSITION"]), count(p["indices"]) // 3)
        for mesh in document["meshes"]
        for p in mesh["primitives"]
    ]


def load(path):
    """An empty file with the meshes of a GLB joined, which have all vertices and triangles."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(path))
    objects = [item for item in bpy.data.objects if item.type == "MESH"]
    expected = primitives(path)
    count = lambda list_of: sum(len(getattr(item.data, list_of)) for item in objects)
    found = (count("vertices"), count("polygons"))
    must(found == tuple(map(sum, zip(*expected))), f"{found} vertices and triangles of {expected}")
    must(count("materials") == len(expected), "materials are missing")
    for item in objects:
        item.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]
    if len(objects) > 1:
        bpy.ops.object.join()
    return objects[0].data


class Nodes:
    """Builds what a material emits."""

    def __init__(self, material):
        self.tree = material.node_tree
        self.output = next(n for n in self.tree.nodes if n.type == "OUTPUT_MATERIAL" and n.is_active_output)

    def join(self, kind, *inputs, **settings):
        """The first output of a new node with these inputs, values or outputs of others."""
        node = self.tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        for socket, value in zip(node.inputs, inputs):
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, socket)
            elif value is not None:
                socket.default_value = value
        return node.outputs["Vector" if kind == "ShaderNodeVectorMath" else 0]

    def vector(self, operation, *inputs):
        return self.join("ShaderNodeVectorMath", *inputs, operation=operation)

    def attribute(self, name):
        node = self.tree.nodes.new("ShaderNodeAttribute")
        node.attribute_name = name
        return node.outputs["Vector"]

    def emit(self, colour):
        shader = self.join("ShaderNodeEmission", colour)
        self.tree.links.new(shader, self.output.inputs["Surface"])

    def own(self, name):
        """What the imported shader has as an input."""
        shader = next(n for n in self.tree.nodes if n.type == "BSDF_PRINCIPLED")
        socket = shader.inputs[name]
        if socket.is_linked:
            return socket.links[0].from_socket
        value = socket.default_value
        return [value] * 3 if isinstance(value, float) else list(value)[:3]


def emit_vertices(mesh):
    must("_RADIOSITY" in mesh.attributes, f"no _RADIOSITY in {list(mesh.attributes.keys())}")
    must(len(mesh.color_attributes) == 1, "no colour attribute")
    for material in mesh.materials:
        nodes = Nodes(material)
        nodes.emit(nodes.vector("MULTIPLY", nodes.attribute("_RADIOSITY"), [1 / math.pi] * 3))


def emit_map(mesh, path):
    must(len(mesh.uv_layers) == 2, f"{len(mesh.uv_layers)} sets of texture coordinates")
    image = bpy.data.images.load(str(path))
    for material in mesh.materials:
        nodes = Nodes(material)
        uv = nodes.join("ShaderNodeUVMap", uv_map=mesh.uv_layers[1].name)
        light = nodes.join("ShaderNodeTexImage", uv, image=image, extension="EXTEND")
        reflected = nodes.vector("MULTIPLY", nodes.own("Base Color"), light)
        emitted = nodes.vector("MULTIPLY", nodes.own("Emission Color"), nodes.own("Emission Strength"))
        nodes.emit(nodes.vector("ADD", reflected, emitted))


def z_up(place):
    x, y, z = place
    return Vector((x, -z, y))


def pixels(path):
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    values = numpy.empty(len(image.pixels), numpy.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], -1)


def render(view, path):
    scene = bpy.context.scene
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.location = z_up(view["eye"])
    camera.rotation_euler = (z_up(view["target"]) - camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.sensor_fit = "VERTICAL"
    camera.data.angle = math.radians(view["fov"])
    camera.data.clip_start = 0.01
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 64
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.max_bounces = 0
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = False
    scene.render.film_transparent = True
    scene.render.resolution_x, scene.render.resolution_y = view["width"], view["height"]
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return pixels(path)


def difference(theirs, ours):
    """How far radiance is apart where the mesh fills the pixel, as a share of its mean there."""
    seen = theirs[..., 3] > 0.999
    must(seen.mean() > 0.3, f"only {seen.mean():.0%} of the picture is filled")
    apart = numpy.abs(theirs[..., :3] - ours[..., :3])[seen].mean()
    return float(apart / ours[..., :3][seen].mean())


def coded(linear):
    """sRGB codes, 0..255."""
    linear = linear.clip(0, 1)
    curve = numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return (255 * curve).round()


def far(view, directory):
    """The share of pixels in which the mesh as it comes is not our picture."""
    load(directory / f"{view['name']}.glb")
    theirs = coded(render(view, directory / f"{view['name']}-blender.exr")[..., :3])
    ours = (255 * pixels(directory / f"{view['name']}.png")[..., :3]).round()
    return float((abs(theirs - ours).max(axis=2) > 4).mean())


def check(view, directory):
    name = view["name"]
    ours = directory / f"{name}.exr"
    textured = view.get("textured", False)
    apart = far(view, directory)
    must(apart < FAR, f"{apart:.2%} of the pixels are not those of our picture")
    done = [f"all but {apart:.2%} of the pixels as ours"]
    if view.get("holes", False):
        # The materials below have none.
        return done[0]
    for what in ["vertices", "lightmap"]:
        mesh = load(directory / (f"{name}.glb" if what == "vertices" else f"{name}.lightmap.glb"))
        if what == "vertices" and textured:
            # Vertices have the light of the texture's mean.
            continue
        if what == "vertices":
            emit_vertices(mesh)
        else:
            emit_map(mesh, directory / f"{name}.lightmap.exr")
        apart = difference(render(view, directory / f"{name}-blender-{what}.exr"), pixels(ours))
        must(apart < RADIANCE, f"{what}: radiance {apart:.2%} from our picture")
        done.append(f"{what} within {apart:.2%}")
    return ", ".join(done)


def main():
    if len(sys.argv) != 2:
        print("usage: python3 blender.py DIRECTORY", file=sys.stderr)
        return 2
    directory = Path(sys.argv[1]).resolve()
    failed = False
    for view in json.loads((directory / "scenes.json").read_text()):
        try:
            print(f"{view['name']}: {check(view, directory)}", flush=True)
        except AssertionError as error:
            print(f"{view['name']}: {error}", file=sys.stderr, flush=True)
            failed = True
    return int(failed)


sys.exit(main())
