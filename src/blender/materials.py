# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials as keys of a shape (opaque) or of a medium (translucent)."""

from dataclasses import dataclass, field

from . import conventions, nodes

DEFAULT_REFLECTANCE = 0.8
SHADERS = {"BSDF_PRINCIPLED", "BSDF_DIFFUSE", "SUBSURFACE_SCATTERING"}
IGNORED_WEIGHTS = ("Transmission Weight", "Coat Weight")
KEYS_OF_ANY_SHAPE = {"normal_map", "bump_map", "emission"}
EMISSION_SOCKETS = {"BSDF_PRINCIPLED": ("Emission Color", "Emission Strength"), "EMISSION": ("Color", "Strength")}
HOLE_ALPHA = 0.5  # less is a hole


@dataclass
class Surface:
    """Keys for the scene file. With a medium, `shape` has only normal maps and emission."""

    name: str
    shape: dict = field(default_factory=dict)
    medium: dict | None = None
    needs_tangents: bool = False
    color_attribute: str | None = None  # replaces the reflectance; "": the one that the mesh renders with
    is_hole: bool = False  # invisible everywhere


def unit_clamp(value):
    """Colours and weights from 0 to 1; textures unchanged."""
    if isinstance(value, dict):
        return value
    if isinstance(value, list):
        return [min(max(part, 0.0), 1.0) for part in value]
    return min(max(value, 0.0), 1.0)


class MaterialReader:
    """Converts materials; each once."""

    def __init__(self, images, mm_per_unit, warn):
        self.images = images
        self.mm_per_unit = mm_per_unit
        self.warn = warn
        self.surfaces = {}

    def surface_of(self, material):
        if material is None:
            return Surface("", {"reflectance": DEFAULT_REFLECTANCE})
        if material.name_full not in self.surfaces:
            self.surfaces[material.name_full] = self.convert(material)
        return self.surfaces[material.name_full]

    def convert(self, material):
        surface = Surface(material.name_full)
        reader = nodes.SocketReader(material.name_full, self.images, self.warn)
        shader = self.shader_of(material)
        settings = getattr(material, "opaline", None)
        preset = settings.medium if settings is not None else ""
        if shader is None:
            surface.shape = {"reflectance": unit_clamp([float(part) for part in material.diffuse_color[:3]])}
        else:
            self.read_normals(surface, reader, shader)
            if shader.type == "BSDF_PRINCIPLED":
                self.read_principled(surface, reader, shader, reads_medium=not preset)
            elif shader.type == "SUBSURFACE_SCATTERING":
                self.read_scattering(surface, reader, shader)
            elif shader.type == "EMISSION":
                surface.shape["reflectance"] = 0
            else:
                self.read_reflectance(surface, reader, nodes.input_named(shader, "Color"))
            if shader.type in EMISSION_SOCKETS:
                self.read_emission(surface, reader, shader)
        if preset:
            self.use_preset(surface, reader, shader, preset)
        elif surface.medium is not None and settings is not None:
            surface.medium["texture_mix"] = settings.texture_mix
        if shader is not None:
            self.read_alpha(surface, reader, nodes.input_named(shader, "Alpha"))
        return surface

    def shader_of(self, material):
        """The supported shader nearest to the output; None without one."""
        output = nodes.active_output(material.node_tree, "OUTPUT_MATERIAL") if material.node_tree else None
        if output is None:
            return None
        surface = nodes.input_named(output, "Surface")
        upstream = nodes.nodes_before(surface)
        shader = nearest_shader(upstream)
        if shader is None:
            self.warn(f"{material.name_full}: no Principled BSDF; its viewport colour is used")
        elif upstream[0] is not shader:
            self.warn(f"{material.name_full}: only {shader.name} is exported, not {upstream[0].name}")
        if nodes.source_of(nodes.input_named(output, "Displacement")) is not None:
            self.warn(f"{material.name_full}: displacement is not exported")
        return shader

    def read_normals(self, surface, reader, shader):
        origin = nodes.source_of(nodes.input_named(shader, "Normal"))
        if origin is None:
            return
        node = origin.node
        if node.type == "BUMP":
            height = nodes.source_of(nodes.input_named(node, "Height"))
            texture = reader.texture(height) if height is not None else None
            if texture is not None:
                sign = -1 if node.invert else 1
                scale = reader.number(nodes.input_named(node, "Distance")) * reader.number(
                    nodes.input_named(node, "Strength"))
                if sign > 0:
                    surface.shape["bump_map"] = {**texture, "color_space": "linear", "scale": scale}
                    return
        elif node.type == "NORMAL_MAP" and node.space == "TANGENT":
            color = nodes.source_of(nodes.input_named(node, "Color"))
            texture = reader.texture(color) if color is not None else None
            if texture is not None:
                surface.shape["normal_map"] = {**texture, "scale": reader.number(nodes.input_named(node, "Strength"))}
                surface.needs_tangents = True
                return
        self.warn(f"{surface.name}: {node.name} is not exported; the normals are those of the mesh")

    def read_principled(self, surface, reader, shader, reads_medium):
        def socket(name):
            return nodes.input_named(shader, name)

        for name in IGNORED_WEIGHTS:
            if socket(name) is not None and (socket(name).is_linked or constant_of_or_zero(socket(name)) > 0):
                self.warn(f"{surface.name}: '{name}' is not exported")
        weight = unit_clamp(reader.value(socket("Subsurface Weight")))
        metallic = unit_clamp(reader.value(socket("Metallic")))
        is_translucent = reads_medium and weight != 0 and metallic != 1
        if is_translucent and metallic != 0:
            self.warn(f"{surface.name}: 'Metallic' is ignored below a translucent surface")
        specular = self.specular_keys(reader, shader)
        if is_translucent:
            color = unit_clamp(reader.value(socket("Base Color")))
            surface.medium = self.medium_keys(surface, reader, shader, weight, color) | specular
        else:
            self.read_reflectance(surface, reader, socket("Base Color"))
            if metallic != 0 or specular["specular_weight"] != 0:
                surface.shape |= specular | {"metalness": metallic}
            else:
                surface.shape |= {key: value for key, value in specular.items() if key.startswith("fuzz")}

    def read_reflectance(self, surface, reader, socket):
        """Colour of an opaque surface."""
        surface.color_attribute = nodes.color_attribute_of(socket)
        if surface.color_attribute is None:
            surface.shape["reflectance"] = unit_clamp(reader.value(socket))

    def read_emission(self, surface, reader, shader):
        """Emitted radiance: the strength is the radiance of a white colour, for any unit."""
        color_socket, strength_socket = (nodes.input_named(shader, name) for name in EMISSION_SOCKETS[shader.type])
        strength = reader.number(strength_socket)
        if strength <= 0:
            return
        color = reader.value(color_socket)
        if isinstance(color, dict):
            surface.shape["emission"] = color | {"scale": strength}
        elif any(part > 0 for part in color):
            surface.shape["emission"] = [max(part * strength, 0.0) for part in color]

    def read_alpha(self, surface, reader, socket):
        """Opaque surfaces have holes where alpha is low."""
        alpha = reader.value(socket) if socket is not None else 1.0
        if alpha == 1:
            return
        if surface.medium is not None or "emission" in surface.shape:
            self.warn(f"{surface.name}: 'Alpha' is not exported; a translucent or emitting surface has no holes")
            return
        if alpha != 0:
            self.warn(f"{surface.name}: 'Alpha' below {HOLE_ALPHA} is a hole, and the rest is opaque")
        if isinstance(alpha, dict):
            surface.shape["opacity"] = alpha
        else:
            surface.is_hole = alpha < HOLE_ALPHA

    def specular_keys(self, reader, shader):
        """The dielectric boundary and the sheen of a Principled BSDF."""
        def socket(name):
            return nodes.input_named(shader, name)

        keys = {
            "specular_roughness": unit_clamp(reader.value(socket("Roughness"))),
            "specular_ior": min(max(reader.number(socket("IOR"), 1.5), 0.1), 10.0),
            "specular_weight": min(2 * reader.number(socket("Specular IOR Level"), 0.5), 1.0),
        }
        anisotropy = unit_clamp(reader.value(socket("Anisotropic")))
        if anisotropy != 0:
            rotation = reader.value(socket("Anisotropic Rotation"))
            keys["specular_anisotropy"] = anisotropy
            keys["specular_rotation"] = rotation if isinstance(rotation, dict) else 360 * rotation
        sheen = reader.number(socket("Sheen Weight"))
        if sheen > 0:
            keys["fuzz_weight"] = min(sheen, 1.0)
            keys["fuzz_color"] = unit_clamp(reader.value(socket("Sheen Tint"), may_be_texture=False))
            keys["fuzz_roughness"] = unit_clamp(reader.number(socket("Sheen Roughness"), 0.5))
        return keys

    def medium_keys(self, surface, reader, shader, weight, color):
        """The medium below a Principled BSDF, by Cycles' convention of the radius."""
        def socket(name):
            return nodes.input_named(shader, name)

        constant = color if isinstance(color, list) else self.images.mean_of(reader.image_of(socket("Base Color")))
        anisotropy = reader.number(socket("Subsurface Anisotropy"))
        lengths = conventions.mean_free_path(
            shader.subsurface_method, reader.value(socket("Subsurface Radius"), may_be_texture=False),
            reader.number(socket("Subsurface Scale"), 0.05), anisotropy, constant,
            reader.number(socket("Subsurface IOR"), 1.4))
        keys = {
            "subsurface_color": color,
            "subsurface_radius": [length * self.mm_per_unit for length in lengths],
            "subsurface_scatter_anisotropy": anisotropy,
        }
        if weight != 1:
            keys |= {"subsurface_weight": weight, "base_color": color}
        return keys

    def read_scattering(self, surface, reader, shader):
        """The medium of a Subsurface Scattering node: all light enters it."""
        def socket(name):
            return nodes.input_named(shader, name)

        color = unit_clamp(reader.value(socket("Color")))
        constant = color if isinstance(color, list) else self.images.mean_of(reader.image_of(socket("Color")))
        anisotropy = reader.number(socket("Anisotropy"))
        lengths = conventions.mean_free_path(
            shader.falloff, reader.value(socket("Radius"), may_be_texture=False), reader.number(socket("Scale"), 0.05),
            anisotropy, constant, reader.number(socket("IOR"), 1.4))
        surface.medium = {
            "subsurface_color": color,
            "subsurface_radius": [length * self.mm_per_unit for length in lengths],
            "subsurface_scatter_anisotropy": anisotropy,
            "specular_ior": reader.number(socket("IOR"), 1.4),
            "specular_weight": 0.0,
        }

    def use_preset(self, surface, reader, shader, preset):
        """A measured medium, with the roughness of the Principled BSDF."""
        surface.medium, surface.color_attribute = {"preset": preset}, None
        if shader is not None and shader.type == "BSDF_PRINCIPLED":
            surface.medium["specular_roughness"] = unit_clamp(reader.value(nodes.input_named(shader, "Roughness")))
        surface.shape = {key: value for key, value in surface.shape.items() if key in KEYS_OF_ANY_SHAPE}


def nearest_shader(upstream):
    """The first supported shader, or else the first emission, of these nodes; None without one."""
    return next((node for node in upstream if node.type in SHADERS),
                next((node for node in upstream if node.type == "EMISSION"), None))


def is_emitter(material):
    """True if surfaces of a material emit light."""
    output = nodes.active_output(material.node_tree, "OUTPUT_MATERIAL") if material and material.node_tree else None
    shader = nearest_shader(nodes.nodes_before(nodes.input_named(output, "Surface"))) if output is not None else None
    if shader is None or shader.type not in EMISSION_SOCKETS:
        return False
    color, strength = (nodes.input_named(shader, name) for name in EMISSION_SOCKETS[shader.type])
    return (strength.is_linked or nodes.constant_of(strength) > 0) and (color.is_linked or any(nodes.constant_of(color)))


def constant_of_or_zero(socket):
    value = nodes.constant_of(socket)
    return value if isinstance(value, float) else 0.0
