# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials as keys of a shape (opaque) or of a medium (translucent): UsdPreviewSurface, OpenPBR, Standard Surface."""
from __future__ import annotations

from dataclasses import dataclass

from pxr import UsdGeom

from .networks import VERTEX_COLORS, Network, kind_of
from .records import Surface

NO_MATERIAL = 0.5  # reflectance, as of a shape in a scene file
DIELECTRIC = 0.04  # reflectance at normal incidence for an index of refraction of 1.5


@dataclass(frozen=True)
class Model:
    """Input names of a surface model with subsurface scattering, and their defaults."""

    base_weight: str
    base_default: float
    metalness: str
    specular: str
    ior: str
    roughness: float
    weight: str
    scale: str
    scale_default: float | list
    anisotropy: str
    color_default: list
    radius_default: float | list
    fuzz: tuple[str, str, str]
    fuzz_roughness: float
    normal: str
    ignored: tuple[str, ...]  # weights


MODELS = {
    "open_pbr_surface": Model(
        "base_weight", 1.0, "base_metalness", "specular_weight", "specular_ior", 0.3, "subsurface_weight",
        "subsurface_radius_scale", [1.0, 0.5, 0.25], "subsurface_scatter_anisotropy", [0.8] * 3, 1.0,
        ("fuzz_weight", "fuzz_color", "fuzz_roughness"), 0.5, "geometry_normal",
        ("transmission_weight", "coat_weight", "emission_luminance", "thin_film_weight", "specular_roughness_anisotropy",
         "geometry_thin_walled")),
    "standard_surface": Model(
        "base", 1.0, "metalness", "specular", "specular_IOR", 0.2, "subsurface", "subsurface_scale", 1.0,
        "subsurface_anisotropy", [1.0] * 3, [1.0] * 3, ("sheen", "sheen_color", "sheen_roughness"), 0.3, "normal",
        ("transmission", "coat", "emission", "thin_film_thickness", "specular_anisotropy", "thin_walled")),
}


def within(value, low=0.0, high=1.0):
    """A number or colour between bounds; textures unchanged."""
    if isinstance(value, list):
        return [min(max(part, low), high) for part in value]
    return min(max(value, low), high) if isinstance(value, float) else value


def times(value, factor):
    """A colour or texture times a number."""
    if factor == 1:
        return value
    if isinstance(value, dict):
        scale = value.get("scale", 1.0)
        return value | {"scale": [part * factor for part in scale] if isinstance(scale, list) else scale * factor}
    return [part * factor for part in value]


class MaterialReader:
    """Converts materials; each once."""

    def __init__(self, time, mm_per_unit, losses):
        self.time, self.mm_per_unit, self.losses = time, mm_per_unit, losses
        self.surfaces = {}

    def surface_of(self, material, prim):
        """The surface of a bound material; without one, of the prim's displayColor."""
        if not material:
            return self.display_color(prim)
        if material.GetPath() not in self.surfaces:
            self.surfaces[material.GetPath()] = self.read(material) or self.display_color(prim)
        return self.surfaces[material.GetPath()]

    def display_color(self, prim):
        primvar = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance("displayColor")
        colors = primvar.ComputeFlattened(self.time) if primvar and primvar.HasValue() else None
        if colors is None or len(colors) == 0:
            return Surface("", shape={"reflectance": NO_MATERIAL})
        if len(colors) == 1:
            return Surface("", shape={"reflectance": within([float(part) for part in colors[0]])})
        return Surface("", shape={"reflectance": [1.0] * 3}, has_vertex_colors=True)

    def read(self, material):
        shader = material.ComputeSurfaceSource("mtlx")[0]  # or the one of all renderers
        kind = kind_of(shader) if shader else "no surface"
        if kind not in (*MODELS, "UsdPreviewSurface"):
            preview = material.ComputeSurfaceSource()[0]
            if shader and preview and kind_of(preview) == "UsdPreviewSurface":
                shader, kind = preview, "UsdPreviewSurface"
            else:
                self.losses.add(f"materials of {kind or 'a shader without a kind'}", material.GetPath())
                return None
        network = Network(material, shader, self.time, self.losses)
        surface = Surface(material.GetPrim().GetName(), str(material.GetPath()))
        if kind == "UsdPreviewSurface":
            self.read_preview(network, surface)
        else:
            self.read_model(network, surface, MODELS[kind])
        if material.GetDisplacementOutput().HasConnectedSource():
            network.lose("displacement")
        return surface

    def base_color(self, network, surface, name, otherwise):
        color = network.value(name, otherwise, is_color=True)
        if color is VERTEX_COLORS:
            surface.has_vertex_colors = True
            return [1.0] * 3
        return within(color)

    def read_preview(self, network, surface):
        color = self.base_color(network, surface, "diffuseColor", [0.18] * 3)
        metalness, ior = within(network.value("metallic", 0.0)), within(network.number("ior", 1.5), 0.1, 10)
        keys = {"reflectance": color, "specular_roughness": within(network.value("roughness", 0.5)), "specular_ior": ior}
        if network.constant(network.shader, "useSpecularWorkflow", 0) == 1:
            keys |= self.specular_workflow(network)
        elif metalness != 0:
            keys["metalness"] = metalness
        surface.shape = keys
        self.add_normals(network, surface, "normal")
        opacity = network.value("opacity", 1.0)
        if opacity != 1:
            network.lose("opacity of materials")
        for name, rest in (("emissiveColor", [0.0] * 3), ("clearcoat", 0.0), ("displacement", 0.0)):
            if network.value(name, rest, is_color=name == "emissiveColor") != rest:
                network.lose(f"{name} of materials")

    def specular_workflow(self, network):
        """The dielectric with the mean of the specular colour as its reflectance at normal incidence."""
        color = network.value("specularColor", [0.0] * 3, is_color=True)
        if not isinstance(color, list):
            network.lose("textures of specularColor")
            color = [DIELECTRIC] * 3
        if max(color) - min(color) > 1e-6:
            network.lose("hues of specularColor")
        root = min(max(sum(color) / 3, 0.0), 0.6) ** 0.5
        return {"specular_ior": (1 + root) / (1 - root)}

    def read_model(self, network, surface, model):
        base = self.base_color(network, surface, "base_color", [0.8] * 3)
        base = times(base, within(network.number(model.base_weight, model.base_default)))
        weight = within(network.value(model.weight, 0.0))
        boundary = {
            "specular_roughness": within(network.value("specular_roughness", model.roughness)),
            "specular_ior": within(network.number(model.ior, 1.5), 0.1, 10),
            "specular_weight": within(network.number(model.specular, 1.0)),
        } | self.fuzz(network, model)
        metalness = within(network.value(model.metalness, 0.0))
        if weight == 0 or metalness == 1:
            surface.shape = {"reflectance": base, "metalness": metalness} | boundary
        else:
            if metalness != 0:
                network.lose("metalness above subsurface scattering")
            surface.medium = self.medium(network, model) | boundary
            if weight != 1:
                surface.medium |= {"subsurface_weight": weight, "base_color": base}
        self.add_normals(network, surface, model.normal)
        for name in model.ignored:
            if network.value(name, 0.0) != 0:
                network.lose(f"{name} of materials")
        if network.value("geometry_opacity" if model.normal == "geometry_normal" else "opacity", 1.0) not in (1, [1, 1, 1]):
            network.lose("opacity of materials")
        if network.value("specular_color", [1.0] * 3, is_color=True) != [1, 1, 1]:
            network.lose("specular_color of materials")

    def fuzz(self, network, model):
        weight = within(network.number(model.fuzz[0], 0.0))
        if weight == 0:
            return {}
        color = network.value(model.fuzz[1], [1.0] * 3, is_color=True)
        if not isinstance(color, list):
            network.lose(f"textures of {model.fuzz[1]}")
            color = [1.0] * 3
        return {"fuzz_weight": weight, "fuzz_color": within(color),
                "fuzz_roughness": within(network.number(model.fuzz[2], model.fuzz_roughness))}

    def medium(self, network, model):
        """subsurface_radius is the mean free path in stage units, times the scale per channel."""
        color = network.value("subsurface_color", model.color_default, is_color=True)
        if color is VERTEX_COLORS:
            network.lose("vertex colours of subsurface_color")
            color = model.color_default
        radius = network.value("subsurface_radius", model.radius_default)
        scale = network.value(model.scale, model.scale_default)
        if isinstance(scale, dict):
            network.lose(f"textures of {model.scale}")
            scale = model.scale_default
        scales = scale if isinstance(scale, list) else [scale] * 3
        if isinstance(radius, dict):
            own = radius.get("scale", 1.0)
            factors = own if isinstance(own, list) else [own] * 3
            radius = radius | {"scale": [a * b * self.mm_per_unit for a, b in zip(factors, scales)]}
        else:
            radii = radius if isinstance(radius, list) else [radius] * 3
            radius = [max(a * b, 0.0) * self.mm_per_unit for a, b in zip(radii, scales)]
        return {"subsurface_color": within(color), "subsurface_radius": radius,
                "subsurface_scatter_anisotropy": within(network.number(model.anisotropy, 0.0), -0.99, 0.99)}

    def add_normals(self, network, surface, name):
        """A tangent-space map, as UsdUVTexture or below MaterialX's normalmap."""
        source = network.source(network.shader, name)
        if source is None:
            return
        shader, output = source
        texture = None
        if kind_of(shader) == "normalmap":
            inner = network.source(shader, "in")
            texture = network.node_value(*inner, False) if inner is not None else None
            scale = network.constant(shader, "scale", 1.0)
            if isinstance(texture, dict):
                texture["scale"] = float(scale if isinstance(scale, float) else scale[0])
        elif kind_of(shader) == "UsdUVTexture":
            texture = network.node_value(shader, output, False)
        if not isinstance(texture, dict):
            network.lose("maps of normals")
            return
        texture.pop("channel", None)
        texture.pop("color_space", None)
        surface.shape["normal_map"] = texture
