# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes, instances, units and time of USD files, by the images of their conversions."""
import numpy as np
import pytest

UsdUtils = pytest.importorskip("pxr.UsdUtils", reason="usd-core is not installed")
from pxr import Usd

import opaline
from opaline import usd
from opaline.usd import meshes, polygons, solids
from usd_stages import (CAMERA, CUBE_FACES, CUBE_POINTS, SUN, VIEW, converted, document_of, keys_of, material, mesh, rendered, texts, triangles_of,
                        write_stage)

BY_HAND = {
    "mm_per_unit": 1000,
    "shapes": [{"name": "cube", "mesh": (np.array(CUBE_POINTS, float), triangles_of(CUBE_FACES)), "normals": "faceted",
                "reflectance": [0.8, 0.4, 0.2], "transform": [{"rotate": {"axis": [0, 1, 0], "degrees": 30}}]}],
    "camera": VIEW,
}
TURN = 'double xformOp:rotateY = 30\n    uniform token[] xformOpOrder = ["xformOp:rotateY"]'
COLOR = "color3f[] primvars:displayColor = [(0.8, 0.4, 0.2)]"


def sun(intensity):
    """The light of SUN, from its rotations: first about x, then y."""
    x, y = np.radians([-40, 30])
    about_y = np.array([[np.cos(y), 0, np.sin(y)], [0, 1, 0], [-np.sin(y), 0, np.cos(y)]])
    about_x = np.array([[1, 0, 0], [0, np.cos(x), -np.sin(x)], [0, np.sin(x), np.cos(x)]])
    direction = about_y @ about_x @ [0, 0, -1]
    return {"name": "Sun", "type": "directional", "direction": direction.tolist(), "irradiance": intensity}


@pytest.mark.parametrize("ending, tolerance", [(".json", 1e-5), (".glb", 2e-3)])
def test_a_mesh_as_by_hand(tmp_path, ending, tolerance):
    """Claim: a cube of quads, turned, under a sun, has the image of the scene written by hand. Tolerance: single precision; in a
    GLB, every opaque surface is glossy, here of weight 0, by tables.
    Fails if: a matrix is transposed, a face is cut or wound otherwise, or the angle of view is that of the wider side."""
    path, losses = converted(tmp_path, mesh(rest=f"{COLOR}\n    {TURN}") + CAMERA + SUN, ending)
    expected = rendered(BY_HAND | {"lights": [sun(3)]})
    assert losses == [] and expected[..., :3].max() > 0.5
    assert np.abs(rendered(path) - expected).max() < tolerance


@pytest.mark.parametrize("ending", [".json", ".glb"])
def test_units_and_axes(tmp_path, ending):
    """Claim: a scene in metres with y up and in centimetres with z up has one image, of its medium in mm too. Tolerance: 2e-3 of
    the brightest pixel: samples fall elsewhere. Fails if: radii, lights or nodes miss a unit, or an axis is flipped."""
    wax = material("Wax", "ND_open_pbr_surface_surfaceshader",
                   "float inputs:subsurface_weight = 1\ncolor3f inputs:subsurface_color = (0.8, 0.6, 0.4)\n"
                   "float inputs:subsurface_radius = {0}", output="mtlx:surface")
    bind = "rel material:binding = </Wax>"
    light = """
def SphereLight "Key"
{{
    float inputs:intensity = 4000
    float inputs:radius = {0}
    bool treatAsPoint = 1
    double3 xformOp:translate = {1}
    uniform token[] xformOpOrder = ["xformOp:translate"]
}}
"""
    first, _ = converted(tmp_path, wax.replace("{0}", "0.1") + mesh(rest=bind) + CAMERA + light.format(0.1, (3, 5, 6)), ending)
    image = rendered(first, **{"settings.samples": 3000, "settings.method": "hierarchical"})
    points = [(100 * x, -100 * z, 100 * y) for x, y, z in CUBE_POINTS]
    camera = (CAMERA.replace("(0, 0, 10)", "(0, -1000, 0)")
              .replace('["xformOp:translate"]', '["xformOp:translate", "xformOp:rotateX"]')
              .replace("double3", "double xformOp:rotateX = 90\n    double3"))
    (tmp_path / "z").mkdir()
    second, _ = converted(tmp_path / "z", wax.replace("{0}", "10") + mesh(points=points, rest=bind) + camera
                          + light.format(10, (300, -600, 500)), ending, head='metersPerUnit = 0.01\n    upAxis = "Z"')
    other = rendered(second, **{"settings.samples": 3000, "settings.method": "hierarchical"})
    assert image[..., :3].max() > 0.1
    assert np.abs(other - image)[..., :3].max() < 2e-3 * image[..., :3].max()


def test_faces_of_all_kinds():
    """Claim: convex and concave polygons keep their area, and triangles their face. By hand: an L of area 3, a quad with a
    reflex corner of area 3/2, a triangle of 1/2; a face of two corners has none. Fails if: a fan crosses a notch."""
    shape = np.array([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2), (0, 0), (2, 0), (1, 0.5), (0, 2)], float)[:, ::-1]
    points = np.concatenate([shape, np.zeros((len(shape), 1))], axis=1)
    counts, vertices = np.array([6, 2, 4, 3]), np.array([0, 1, 2, 3, 4, 5, 0, 1, 7, 8, 9, 6, 0, 2, 3])
    corners, faces = polygons.triangulate(points, counts, vertices)
    places = points[vertices[corners]]
    areas = np.linalg.norm(np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]), axis=1) / 2
    assert np.bincount(faces, areas, 4) == pytest.approx([3, 0, 1.5, 0.5])


def test_orientation(tmp_path):
    """Claim: faces of both orientations become triangles counter-clockwise from outside. By hand: a cube's signed volume is 8. Fails
    if: windings stay as they are."""
    for faces, handed in ((CUBE_FACES, "right"), ([face[::-1] for face in CUBE_FACES], "left")):
        path = write_stage(tmp_path / f"{handed}.usda", mesh(faces=faces, rest=f'uniform token orientation = "{handed}Handed"'))
        stage = Usd.Stage.Open(str(path))
        cube = meshes.Geometry(stage.GetPrimAtPath("/Cube"), "", Usd.TimeCode.Default())
        a, b, c = cube.points[cube.vertices[cube.triangles]].transpose(1, 0, 2)
        assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 == pytest.approx(8)


def test_holes_and_subsets(tmp_path):
    """Claim: a hole is open, and a subset has its own material. Fails if: holes are closed, or faces of a subset are counted twice."""
    lit = SUN.replace("(-40, 30, 0)", "(-20, 20, 0)")
    expected = rendered(converted(tmp_path, mesh(rest=COLOR) + CAMERA + lit)[0])
    keys = keys_of(tmp_path, mesh(rest=f"{COLOR}\nint[] holeIndices = [0, 1]") + CAMERA + lit)
    assert len(keys["shapes"]) == 1
    assert expected[18, 24, 3] == 1 and rendered(tmp_path / "converted.json")[18, 24, 3] == 0
    subset = """
    def GeomSubset "Front" (prepend apiSchemas = ["MaterialBindingAPI"])
    {
        uniform token elementType = "face"
        uniform token familyName = "materialBind"
        int[] indices = [1]
        rel material:binding = </Blue>
    }
"""
    blue = material("Blue", "UsdPreviewSurface", "color3f inputs:diffuseColor = (0, 0, 1)")
    parts = rendered(converted(tmp_path, blue + mesh(rest=f"{COLOR}\n{TURN}\n{subset}") + CAMERA + lit)[0])
    colors = parts[parts[..., 3] == 1][:, :3]
    assert (colors[:, 2] > 2 * colors[:, 0]).any() and (colors[:, 0] > 2 * colors[:, 2]).any()


def test_instances(tmp_path):
    """Claim: a point instancer and instanceable references have the image of copies written one by one, and one mesh. Fails if: the
    prototype's own transform is applied twice, or a mask is ignored."""
    places = [(-2, 0, 0), (0.5, 1, -3), (2, -1, 0)]
    small = mesh(rest=COLOR + '\n    float3 xformOp:scale = (0.5, 0.5, 0.5)\n    uniform token[] xformOpOrder = ["xformOp:scale"]')
    copies = "".join(f"""
def Xform "Copy{i}"
{{
    double3 xformOp:translate = {place}
    uniform token[] xformOpOrder = ["xformOp:translate"]
{small}
}}
""" for i, place in enumerate(places))
    (tmp_path / "a").mkdir()
    expected = rendered(converted(tmp_path / "a", copies + CAMERA + SUN)[0])
    instancer = f"""
def PointInstancer "Many"
{{
    rel prototypes = [</Many/Cube>]
    int[] protoIndices = [0, 0, 0, 0]
    point3f[] positions = [{texts(places[:2])}, (0, 0, 2), {texts(places[2:])}]
    int64[] invisibleIds = [2]
{small}
}}
"""
    path, losses = converted(tmp_path, instancer + CAMERA + SUN)
    assert losses == [] and np.abs(rendered(path) - expected).max() < 1e-5
    references = f"""
class "Source"
{{
{small}
}}
""" + "".join(f"""
def Xform "Copy{i}" (instanceable = true
    prepend references = </Source>)
{{
    double3 xformOp:translate = {place}
    uniform token[] xformOpOrder = ["xformOp:translate"]
}}
""" for i, place in enumerate(places))
    keys = keys_of(tmp_path, references + CAMERA + SUN)
    assert np.abs(rendered(tmp_path / "converted.json") - expected).max() < 1e-5
    assert {shape["part"] for shape in keys["shapes"]} == {"0/0"} and len(keys["shapes"]) == 3


def test_visible_prims_at_a_time(tmp_path):
    """Claim: invisible prims, guides and proxies are left out; a time code moves what is animated, the start of the stage by
    default. Fails if: values at the default time, unset here, are read."""
    moved = "double3 xformOp:translate.timeSamples = { 1: (0, 0, 0), 5: (4, 0, 0) }\nuniform token[] xformOpOrder = [\"xformOp:translate\"]"
    body = (mesh(rest=moved) + mesh("Hidden", rest='token visibility = "invisible"') + CAMERA
            + mesh("Guide", rest='uniform token purpose = "guide"'))
    head = 'metersPerUnit = 1\n    upAxis = "Y"\n    startTimeCode = 2\n    endTimeCode = 5'
    for time, x in ((None, 1), (4, 3), (1, 0)):
        shapes = keys_of(tmp_path, body, head=head, time=time)["shapes"]
        assert [shape["name"] for shape in shapes] == ["Cube"]
        assert shapes[0]["transform"][0]["matrix"][0] == pytest.approx([1, 0, 0, x])


def test_poses(tmp_path):
    """Claim: a skinned mesh has its pose at the time, between two keys too. By hand: a joint moves from 0 to 9 in 9 frames. Fails if:
    the rest pose is kept, or the nearest key is taken."""
    body = """
def SkelRoot "Root" (prepend apiSchemas = ["SkelBindingAPI"])
{
    def Skeleton "Bones" (prepend apiSchemas = ["SkelBindingAPI"])
    {
        uniform token[] joints = ["a"]
        uniform matrix4d[] bindTransforms = [((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))]
        uniform matrix4d[] restTransforms = [((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))]
        rel skel:animationSource = </Root/Walk>
    }
    def SkelAnimation "Walk"
    {
        uniform token[] joints = ["a"]
        float3[] translations.timeSamples = { 1: [(0, 0, 0)], 10: [(9, 0, 0)] }
        quatf[] rotations = [(1, 0, 0, 0)]
        half3[] scales = [(1, 1, 1)]
    }
    def Mesh "Skin" (prepend apiSchemas = ["SkelBindingAPI"])
    {
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
        uniform token subdivisionScheme = "none"
        rel skel:skeleton = </Root/Bones>
        int[] primvars:skel:jointIndices = [0, 0, 0] (
            elementSize = 1
            interpolation = "vertex"
        )
        float[] primvars:skel:jointWeights = [1, 1, 1] (
            elementSize = 1
            interpolation = "vertex"
        )
    }
}
"""
    head = 'metersPerUnit = 1\n    upAxis = "Y"\n    startTimeCode = 1\n    endTimeCode = 10'
    for time, x in ((None, 0), (5.5, 4.5), (10, 9)):
        path, losses = converted(tmp_path, body, ".glb", head=head, time=time)
        assert losses == []
        document = document_of(path)
        position = document["accessors"][document["meshes"][0]["primitives"][0]["attributes"]["POSITION"]]
        assert (position["min"][0], position["max"][0]) == pytest.approx((x, x + 1))


def test_normals_and_cages(tmp_path):
    """Claim: a polygon mesh without normals is faceted, a subdivision cage smooth and named, and normals by corner with an index
    are those of their faces. Fails if: normals of a cage are read, or the interpolation is ignored."""
    lit = CAMERA + SUN
    faceted = rendered(converted(tmp_path, mesh(rest=COLOR) + lit)[0])
    cage, losses = converted(tmp_path, mesh(rest=COLOR, scheme="") + lit)
    assert any("subdivision cages" in line and "/Cube" in line for line in losses), losses
    rounded = rendered(cage)
    assert np.abs(rounded - faceted).max() > 0.01
    normals = [(0, 0, -1), (0, 0, 1), (0, -1, 0), (0, 1, 0), (-1, 0, 0), (1, 0, 0)]
    indexed = (f"normal3f[] primvars:normals = [{texts(normals)}] (interpolation = \"faceVarying\")\n"
               f"int[] primvars:normals:indices = {[face for face in range(6) for _ in range(4)]}")
    path, losses = converted(tmp_path, mesh(rest=f"{COLOR}\n{indexed}", scheme="") + lit)
    assert losses == [] and np.abs(rendered(path) - faceted).max() < 1e-5
    scheme = 'uniform token subdivisionScheme = "catmullClark"'
    smooth, _ = converted(tmp_path, mesh(rest=f"{COLOR}\n{indexed}", scheme=scheme) + lit)
    assert np.abs(rendered(smooth) - rounded).max() < 1e-5


def test_solids():
    """Claim: solids enclose their volume with outward faces. By hand: cube 8, sphere 4/3 pi, cylinder 2 pi, cone 2/3 pi, capsule
    10/3 pi. Tolerance: 1 %, of chords. Fails if: a cap is missing or turned inwards, or triangles at a pole
    have no area."""
    sizes = {"size": 2, "radius": 1, "height": 2, "radiusBottom": 1, "radiusTop": 1}
    for name, expected in {"Cube": 8, "Sphere": 4 / 3 * np.pi, "Cylinder": 2 * np.pi, "Cone": 2 / 3 * np.pi,
                           "Capsule": 10 / 3 * np.pi, "Cylinder_1": 2 * np.pi}.items():
        build, arguments = solids.SOLIDS[name]
        points, _, faces = build(*(sizes[argument] for argument in arguments))
        corners, _ = polygons.triangulate(points, np.full(len(faces), 4), faces.ravel())
        a, b, c = points[faces.ravel()[corners]].transpose(1, 0, 2)
        assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 == pytest.approx(expected, rel=.01), name
        assert np.linalg.norm(np.cross(b - a, c - a), axis=1).min() > 1e-4, name


def test_a_cone_points_along_its_axis(tmp_path):
    """Claim: the apex of a cone along x is at +x. Fails if: coordinates are permuted the other way."""
    body = 'def Cone "Cone"\n{\n    uniform token axis = "X"\n    double height = 4\n}\n' + CAMERA + SUN
    alpha = rendered(converted(tmp_path, body)[0])[..., 3]
    assert (alpha[:, :24] > 0).sum() > 2 * (alpha[:, 24:] > 0).sum() > 0


def test_packages(tmp_path):
    """Claim: a .usdz renders as its stage, with its texture in the GLB or beside the scene file. Fails if: an image is looked for
    outside the package."""
    nodes = """
    def Shader "Image"
    {
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @textures/paint.png@
        color3f outputs:rgb
    }
"""
    paint = material("Paint", "UsdPreviewSurface", "color3f inputs:diffuseColor.connect = </Paint/Image.outputs:rgb>", nodes)
    uvs = 'texCoord2f[] primvars:st = [(0, 0), (1, 0), (0, 1), (1, 1), (0, 0), (1, 0), (0, 1), (1, 1)] (interpolation = "vertex")'
    body = paint + mesh(rest=f"rel material:binding = </Paint>\n{uvs}") + CAMERA + SUN
    (tmp_path / "textures").mkdir()
    pixels = np.zeros((4, 4, 3), np.float32)
    pixels[:2, :, 0] = pixels[2:, :, 1] = 1  # red above green
    opaline.image(pixels, ["R", "G", "B"]).write(str(tmp_path / "textures/paint.png"), view="srgb")
    expected = rendered(converted(tmp_path, body)[0])
    assert expected[12, 24, 0] > 5 * expected[12, 24, 1] and expected[24, 24, 1] > 5 * expected[24, 24, 0]
    package = tmp_path / "moved" / "stage.usdz"
    package.parent.mkdir()
    assert UsdUtils.CreateNewUsdzPackage(str(tmp_path / "stage.usda"), str(package))
    for ending in (".json", ".glb"):
        assert usd.convert(package, package.with_suffix(ending)) == []
        assert np.abs(rendered(package.with_suffix(ending)) - expected).max() < 1e-5
    assert sorted(path.name for path in package.parent.iterdir()) == [
        "stage.glb", "stage.json", "stage.meshes.glb", "stage.textures", "stage.usdz"]


@pytest.mark.parametrize("broken, message", [
    ("int[] faceVertexIndices = [0, 1, 8]\nint[] faceVertexCounts = [3]", "/Cube: faceVertexIndices has values from 0 to 8, expected 0 to 7"),
    ("int[] faceVertexIndices = [0, 1]\nint[] faceVertexCounts = [3]", "/Cube: faceVertexIndices has 2 values, expected 3"),
    ("int[] faceVertexIndices = [0, 1, 2]\nint[] faceVertexCounts = [3]\nnormal3f[] normals = [(0, 0, 1)]",
     "/Cube: normals has 1 values, expected 8 \\(vertex\\)"),
])
def test_broken_meshes(tmp_path, broken, message):
    """Claim: an error names the file, the prim, the value and the expectation, and no file is written. Source: STYLE of errors."""
    body = f'def Mesh "Cube"\n{{\n    point3f[] points = [{texts(CUBE_POINTS)}]\n    {broken}\n    uniform token subdivisionScheme = "none"\n}}\n'
    with pytest.raises(usd.UsdError, match=f"stage.usda: {message}") as caught:
        converted(tmp_path, body, ".glb")
    assert caught.value.prim == "/Cube" and not (tmp_path / "converted.glb").exists()


def test_unusable_files(tmp_path):
    """Claim: a missing file, one in another format, a broken one, a stage without meshes and an unknown output are named. Fails if:
    an error of the USD library comes through."""
    for name, message in (("none.usda", "no such file"), ("a.txt", "not a USD file"), ("b.usda", "cannot be read: .*b.usda")):
        if name != "none.usda":
            (tmp_path / name).write_text("#usda 1.0\ndef Mesh {")
        with pytest.raises(usd.UsdError, match=f"{name}: .*{message}"):
            usd.convert(tmp_path / name, tmp_path / "a.glb")
    empty = write_stage(tmp_path / "empty.usda", CAMERA)
    with pytest.raises(usd.UsdError, match="has no visible mesh"):
        usd.convert(empty, tmp_path / "a.glb")
    with pytest.raises(usd.UsdError, match="expected .glb or .json"):
        usd.convert(empty, tmp_path / "a.obj")
