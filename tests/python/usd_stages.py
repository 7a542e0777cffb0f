# SPDX-License-Identifier: GPL-3.0-or-later
"""Small USD stages as text, and their conversion."""
import json

import numpy as np

import opaline
from opaline import usd

FILM = {"film.resolution": [48, 36], "film.samples_per_pixel": 4, "film.pixel_type": "float"}

# A cube of edge 2 around the origin, its faces counter-clockwise from outside.
CUBE_POINTS = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
CUBE_FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]

CAMERA = """
def Camera "View"
{
    float focalLength = 40
    float horizontalAperture = 24
    float verticalAperture = 18
    double3 xformOp:translate = (0, 0, 10)
    uniform token[] xformOpOrder = ["xformOp:translate"]
}
"""
VIEW = {"position": [0, 0, 10], "look_at": [0, 0, 0], "field_of_view": np.degrees(2 * np.arctan(9 / 40))}
SUN = """
def DistantLight "Sun"
{
    float inputs:intensity = 3
    float inputs:angle = 0
    float3 xformOp:rotateXYZ = (-40, 30, 0)
    uniform token[] xformOpOrder = ["xformOp:rotateXYZ"]
}
"""


def texts(rows):
    return ", ".join(str(tuple(float(part) for part in row)) for row in rows)


def mesh(name="Cube", points=CUBE_POINTS, faces=CUBE_FACES, rest="", scheme='uniform token subdivisionScheme = "none"'):
    """A prim of type Mesh; rest: more of its properties and children."""
    return f"""
def Mesh "{name}" (prepend apiSchemas = ["MaterialBindingAPI"])
{{
    int[] faceVertexCounts = {[len(face) for face in faces]}
    int[] faceVertexIndices = {[corner for face in faces for corner in face]}
    point3f[] points = [{texts(points)}]
    {scheme}
    {rest}
}}
"""


def material(name, identifier, inputs, nodes="", output="surface"):
    """A material with one surface shader; inputs: lines of its properties; nodes: further shaders."""
    return f"""
def Material "{name}"
{{
    token outputs:{output}.connect = </{name}/Surface.outputs:surface>
    def Shader "Surface"
    {{
        uniform token info:id = "{identifier}"
        {inputs}
        token outputs:surface
    }}
    {nodes}
}}
"""


def write_stage(path, body, head='metersPerUnit = 1\n    upAxis = "Y"'):
    path.write_text(f"#usda 1.0\n(\n    {head}\n)\n{body}")
    return path


def converted(tmp_path, body, ending=".json", head='metersPerUnit = 1\n    upAxis = "Y"', **options):
    """Path of the converted stage, and the lines of losses."""
    source = write_stage(tmp_path / "stage.usda", body, head)
    target = tmp_path / f"converted{ending}"
    return target, usd.convert(source, target, **options)


def keys_of(tmp_path, body, **options):
    """The scene file of a stage, as a dict."""
    path, _ = converted(tmp_path, body, **options)
    return json.loads(path.read_text())


def rendered(scene, **overrides):
    """R, G, B and alpha: height x width x 4."""
    image = opaline.render(scene, FILM | overrides)
    assert image.channels[:4] == ["R", "G", "B", "A"]
    return image.array[..., :4]


def document_of(path):
    """The JSON of a GLB."""
    data = path.read_bytes()
    return json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])


def triangles_of(faces):
    return np.array([(face[0], face[i], face[i + 1]) for face in faces for i in range(1, len(face) - 1)])
