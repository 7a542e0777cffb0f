# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights and the world.

A point light of P watts has the radiant intensity P / (4 pi), an area light of area A the radiance P / (pi A), a sun the
irradiance of its strength.
"""

import math

import numpy as np

from . import conventions, nodes

DISC_SIDE = math.sqrt(math.pi) / 2  # side of a square over the diameter of a disc with the same area
LEAST_ANGLE = 0.004  # degrees; less is a parallel light


def emission_factor(light, warn):
    """Colour times strength of a light's own nodes."""
    if not light.use_nodes or light.node_tree is None:
        return [1.0] * 3
    output = nodes.active_output(light.node_tree, "OUTPUT_LIGHT")
    origin = nodes.source_of(nodes.input_named(output, "Surface")) if output is not None else None
    if origin is None:
        return [1.0] * 3
    if origin.node.type != "EMISSION":
        warn(f"{light.name}: {origin.node.name} is not exported; the light is uniform")
        return [1.0] * 3
    sockets = [nodes.input_named(origin.node, name) for name in ("Color", "Strength")]
    for socket in sockets:
        if socket.is_linked and nodes.source_of(socket).node.type not in nodes.CONSTANT_NODES:
            warn(f"{light.name}: '{socket.name}' of its nodes is constant")
    color, strength = (nodes.constant_of(nodes.source_of(socket) or socket) for socket in sockets)
    color = color if isinstance(color, list) else [color] * 3
    strength = strength if isinstance(strength, float) else sum(strength) / 3
    return [part * strength for part in color]


def power_of(light, warn):
    """Colour times energy, with the exposure and temperature of newer versions."""
    factor = emission_factor(light, warn)
    energy = light.energy * 2 ** getattr(light, "exposure", 0.0)
    tint = getattr(light, "temperature_color", (1, 1, 1)) if getattr(light, "use_temperature", False) else (1, 1, 1)
    return [max(0.0, energy * float(light.color[c]) * float(tint[c]) * factor[c]) for c in range(3)]


def scaled(color, factor):
    return [part * factor for part in color]


def axes_of(matrix):
    """World directions of the x, y and z axes of an object, with their scale, and its location, y up."""
    rows = np.array(conventions.matrix_rows(matrix))
    return rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3]


def point_keys(light, power, location, mm_per_unit, is_visible):
    """A point light, or a sphere of the same intensity."""
    intensity = scaled(power, 1 / (4 * math.pi))
    radius = light.shadow_soft_size
    if radius <= 0:
        return {"type": "point", "position": location.tolist(), "intensity": scaled(intensity, mm_per_unit**2)}
    area = 1 if getattr(light, "normalize", True) else math.pi * radius**2
    return {"type": "sphere", "center": location.tolist(), "radius": radius, "visible": is_visible,
            "radiance": scaled(intensity, area / (math.pi * radius**2))}


def spot_keys(light, power, location, direction, mm_per_unit):
    """A spot light. Its rim has the flux of Blender's smoothstep, by the square of a ramp 0.75 times as wide."""
    outer = min(light.spot_size / 2, math.pi / 2)
    fade = (1 - math.cos(outer)) * light.spot_blend
    inner = math.acos(min(1.0, math.cos(outer) + 0.75 * fade))
    return {"type": "spot", "position": location.tolist(), "direction": direction.tolist(),
            "intensity": scaled(power, mm_per_unit**2 / (4 * math.pi)),
            "outer_angle": math.degrees(outer), "inner_angle": min(math.degrees(inner), 0.9999 * math.degrees(outer))}


def area_keys(light, power, axes, is_visible):
    """A rectangle emitting along -z of the object. A disc or an ellipse becomes a rectangle of the same area."""
    x, y, z, location = axes
    width = light.size
    height = light.size_y if light.shape in {"RECTANGLE", "ELLIPSE"} else light.size
    if light.shape in {"DISK", "ELLIPSE"}:
        width, height = DISC_SIDE * width, DISC_SIDE * height
    u, v = x * width, -y * height
    if np.dot(np.cross(u, v), z) > 0:
        u, v = v, u
    area = np.linalg.norm(u) * np.linalg.norm(v)
    corner = location - u / 2 - v / 2
    radiance = scaled(power, 1 / (math.pi * (area if getattr(light, "normalize", True) else 1)))
    return {"type": "quad", "corner": corner.tolist(), "u": u.tolist(), "v": v.tolist(), "radiance": radiance,
            "visible": is_visible}


def light_keys(name, light, matrix, mm_per_unit, is_visible, warn):
    """Keys of one light, or None if it emits nothing."""
    power = power_of(light, warn)
    if not any(power):
        return None
    axes = axes_of(matrix)
    direction = -axes[2]
    if light.type == "POINT":
        keys = point_keys(light, power, axes[3], mm_per_unit, is_visible)
    elif light.type == "SPOT":
        keys = spot_keys(light, power, axes[3], direction, mm_per_unit)
        if light.shadow_soft_size > 0:
            warn(f"{name}: a spot light has no radius; its shadows are hard")
    elif light.type == "SUN":
        angle = math.degrees(light.angle)
        keys = {"type": "directional", "direction": direction.tolist(), "irradiance": power, "visible": False}
        if angle >= LEAST_ANGLE:
            keys["angle"] = min(angle, 90.0)
    else:
        keys = area_keys(light, power, axes, is_visible)
        if light.shape in {"DISK", "ELLIPSE"}:
            warn(f"{name}: a round area light becomes a rectangle of its area")
        if light.spread < math.pi - 1e-4:
            warn(f"{name}: the spread of an area light is not exported")
    return {"name": name} | keys


def world_light_name(world):
    """Name of the world's light group, or None if the world is black."""
    if world is None:
        return None
    output = nodes.active_output(world.node_tree, "OUTPUT_WORLD") if world.node_tree else None
    if output is None:
        return "surroundings" if any(world.color) else None
    origin = nodes.source_of(nodes.input_named(output, "Surface"))
    if origin is None or origin.node.type != "BACKGROUND":
        return None
    picture = nodes.source_of(nodes.input_named(origin.node, "Color"))
    if picture is not None and picture.node.type == "TEX_ENVIRONMENT":
        return "world"
    color, strength = (nodes.constant_of(nodes.input_named(origin.node, name)) for name in ("Color", "Strength"))
    return "surroundings" if picture is not None or (any(color) and strength != 0) else None


def environment_keys(world, images, warn):
    """Keys of the scene for the world: (surroundings, environment light); either may be None."""
    if world is None:
        return None, None
    output = nodes.active_output(world.node_tree, "OUTPUT_WORLD") if world.node_tree else None
    if output is None:
        return [float(part) for part in world.color], None
    origin = nodes.source_of(nodes.input_named(output, "Surface"))
    if origin is None:
        return None, None
    background = origin.node
    if background.type != "BACKGROUND":
        warn(f"{world.name}: {background.name} is not exported; the world is black")
        return None, None
    reader = nodes.SocketReader(world.name, images, warn)
    strength = reader.number(nodes.input_named(background, "Strength"), 1.0)
    color = nodes.input_named(background, "Color")
    picture = nodes.source_of(color)
    if picture is None or picture.node.type != "TEX_ENVIRONMENT":
        value = reader.value(color, may_be_texture=False)
        radiance = [max(0.0, part * strength) for part in value]
        return (radiance if any(radiance) else None), None
    return None, map_keys(world, picture.node, strength, images, warn)


def map_keys(world, node, strength, images, warn):
    """An environment map. Blender has +x at the centre of the image, a scene file +z."""
    path = images.path_of(node.image) if node.image is not None else None
    if path is None or node.projection != "EQUIRECTANGULAR":
        warn(f"{world.name}: only environment maps of an image by latitude and longitude are exported")
        return None
    turn = 0.0
    vector = nodes.source_of(nodes.input_named(node, "Vector"))
    if vector is not None and vector.node.type == "MAPPING":
        mapping = vector.node
        rotation = nodes.constant_of(nodes.input_named(mapping, "Rotation"))
        turn = -math.degrees(rotation[2])
        if mapping.vector_type == "TEXTURE":
            turn = -turn
        if any(abs(angle) > 1e-6 for angle in rotation[:2]):
            warn(f"{world.name}: only rotation about z is exported")
    rotation = math.remainder(90 + turn, 360)
    return {"name": "world", "type": "environment", "file": path, "strength": max(0.0, strength), "rotation": rotation}
