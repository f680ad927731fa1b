"""Dresses pairs of meshes of one connectivity as artists do, and exports them by Blender's glTF add-on.

Usage: blender --background --factory-startup --python export_pairs.py -- FOLDER A.glb B.glb [A.glb B.glb ...]

Writes FOLDER/<pair>/a.glb and b.glb: UVs with a seam, two materials of which one has a texture, shape keys with an
action, an armature of two bones with an action, a camera and a lamp. UVs, weights and bones are those of A in both.
"""
import math
import os
import sys

import bpy
import numpy

# Debian 12's add-on uses an alias that its numpy no longer has.
numpy.bool = bool


def read_mesh(path):
    """Points (Blender's axes) and triangles of a file with one mesh."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=path)
    [mesh] = bpy.data.meshes
    return [vertex.co.copy() for vertex in mesh.vertices], [list(polygon.vertices) for polygon in mesh.polygons]


def height_of(points):
    """(point) -> 0 at the feet, 1 at the top; and both heights."""
    low, high = min(p.z for p in points), max(p.z for p in points)
    return (lambda p: (p.z - low) / (high - low)), low, high


def unwrap(mesh, points):
    """Around the upright axis; corners of a face that crosses the back go on beyond 1: a seam."""
    height, _, _ = height_of(points)
    layer = mesh.uv_layers.new(name="UVMap")
    for polygon in mesh.polygons:
        turns = [math.atan2(points[i].x, -points[i].y) / (2 * math.pi) + 0.5 for i in polygon.vertices]
        crosses = max(turns) - min(turns) > 0.5
        for loop, i, turn in zip(polygon.loop_indices, polygon.vertices, turns):
            layer.data[loop].uv = (turn + 1 if crosses and turn < 0.5 else turn, height(points[i]))


def paint(mesh, points):
    """A textured and a plain material; the upper half has the second."""
    image = bpy.data.images.new("checks", 32, 32)
    image.pixels = [value for y in range(32) for x in range(32)
                    for value in ((0.8, 0.6, 0.5, 1) if (x // 4 + y // 4) % 2 else (0.3, 0.2, 0.2, 1))]
    image.pack()
    for name in ("lower", "upper"):
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        mesh.materials.append(material)
    nodes = mesh.materials[0].node_tree
    texture = nodes.nodes.new("ShaderNodeTexImage")
    texture.image = image
    nodes.links.new(texture.outputs["Color"], nodes.nodes["Principled BSDF"].inputs["Base Color"])
    height, _, _ = height_of(points)
    for polygon in mesh.polygons:
        polygon.material_index = int(height(points[polygon.vertices[0]]) > 0.5)
        polygon.use_smooth = True


def add_shape_keys(body):
    """'wide' and 'tall', of which the first comes and goes."""
    body.shape_key_add(name="Basis")
    for name, axis in (("wide", 0), ("tall", 2)):
        key = body.shape_key_add(name=name)
        for point in key.data:
            point.co[axis] *= 1.1
    wide = body.data.shape_keys.key_blocks["wide"]
    for frame, value in ((1, 0.0), (13, 1.0), (25, 0.0)):
        wide.value = value
        wide.keyframe_insert("value", frame=frame)
    wide.value = 0.0


def add_bones(body, points):
    """Two bones, one above the other, that share the vertices between them."""
    height, low, high = height_of(points)
    rig = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    middle = (low + high) / 2
    for name, bottom, top in (("hip", low, middle), ("head", middle, high)):
        bone = rig.data.edit_bones.new(name)
        bone.head, bone.tail = (0, 0, bottom), (0, 0, top)
        bone.parent = rig.data.edit_bones["hip"] if name == "head" else None
    bpy.ops.object.mode_set(mode="OBJECT")
    groups = {name: body.vertex_groups.new(name=name) for name in ("hip", "head")}
    for i, point in enumerate(points):
        share = min(1.0, max(0.0, 2 * height(point) - 0.5))
        groups["hip"].add([i], 1 - share, "REPLACE")
        groups["head"].add([i], share, "REPLACE")
    body.parent = rig
    body.modifiers.new("rig", "ARMATURE").object = rig
    nod = rig.pose.bones["head"]
    nod.rotation_mode = "QUATERNION"
    for frame, angle in ((1, 0.0), (13, 0.3)):
        nod.rotation_quaternion = (math.cos(angle / 2), math.sin(angle / 2), 0, 0)
        nod.keyframe_insert("rotation_quaternion", frame=frame)
    nod.rotation_quaternion = (1, 0, 0, 0)


def export(path, points, triangles, pattern):
    """Exports `points` dressed as `pattern`, the points of A, says."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mesh = bpy.data.meshes.new("body")
    mesh.from_pydata(points, [], triangles)
    body = bpy.data.objects.new("body", mesh)
    scene = bpy.context.scene.collection.objects
    scene.link(body)
    scene.link(bpy.data.objects.new("camera", bpy.data.cameras.new("camera")))
    scene.link(bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "POINT")))
    unwrap(mesh, pattern)
    paint(mesh, pattern)
    add_bones(body, pattern)
    add_shape_keys(body)
    body["maker"] = "somebody"
    os.makedirs(os.path.dirname(path), exist_ok=True)
    bpy.context.scene.frame_set(1)
    bpy.ops.export_scene.gltf(filepath=path, export_format="GLB", export_cameras=True, export_lights=True,
                              export_extras=True, export_morph_normal=True)


def main():
    folder, *files = sys.argv[sys.argv.index("--") + 1:]
    for a, b in zip(files[::2], files[1::2]):
        pattern, triangles = read_mesh(a)
        points, others = read_mesh(b)
        assert triangles == others, f"{a} and {b} differ in connectivity"
        pair = os.path.basename(os.path.dirname(a))
        export(os.path.join(folder, pair, "a.glb"), pattern, triangles, pattern)
        export(os.path.join(folder, pair, "b.glb"), points, triangles, pattern)


main()
