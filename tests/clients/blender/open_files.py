"""Opens glTF files by Blender's importer and tells what it found, as JSON.

Usage: blender --background --factory-startup --python open_files.py -- RESULT FILE...
"""
import json
import sys

import bpy
import numpy

# Debian 12's add-on uses an alias that its numpy no longer has.
numpy.bool = bool


def describe(mesh_object):
    """Vertices of an object's mesh, and how far each of its shape keys moves one of them at most."""
    mesh = mesh_object.data
    blocks = mesh.shape_keys.key_blocks if mesh.shape_keys else []
    moves = {}
    for block in blocks[1:]:
        pairs = zip(block.data, block.relative_key.data)
        moves[block.name] = max((a.co - b.co).length for a, b in pairs)
    return {"vertices": len(mesh.vertices), "triangles": len(mesh.polygons), "moves": moves,
            "skinned": any(modifier.type == "ARMATURE" for modifier in mesh_object.modifiers)}


def open_file(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=path)
    return {"meshes": [describe(each) for each in bpy.data.objects if each.type == "MESH"],
            "actions": len(bpy.data.actions)}


def main():
    result, *files = sys.argv[sys.argv.index("--") + 1:]
    found = {}
    for path in files:
        try:
            found[path] = open_file(path)
        except Exception as error:  # whatever the importer raises is the finding
            found[path] = {"error": str(error)}
    with open(result, "w", encoding="utf-8") as out:
        json.dump(found, out)


main()
