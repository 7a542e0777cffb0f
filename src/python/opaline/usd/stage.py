# SPDX-License-Identifier: GPL-3.0-or-later
"""Stages, their time, units and axes, and their prims with instances."""
from __future__ import annotations

import os

import numpy as np
from pxr import Gf, Tf, Usd, UsdGeom, UsdSkel

from .report import UsdError

MOST_INSTANCES = 100000
VISITED = Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)
FORMATS = (".usd", ".usda", ".usdc", ".usdz")


def open_stage(path, losses):
    """error UsdError: no such file, or not USD"""
    if not os.path.isfile(path):
        raise UsdError(path, "", "no such file")
    if not path.lower().endswith(FORMATS):
        raise UsdError(path, "", f"is not a USD file, expected a name with {', '.join(FORMATS)}")
    try:
        stage = Usd.Stage.Open(path)
    except Tf.ErrorException as error:
        reason = error.args[0].commentary.strip().splitlines()[0] if error.args else "unknown error"
        raise UsdError(path, "", f"cannot be read: {reason}") from error
    for error in stage.GetCompositionErrors():
        losses.add("references without a file", getattr(error, "assetPath", "") or error.rootSite.path)
    stage.SetEditTarget(stage.GetSessionLayer())
    return stage


def time_of(stage, time):
    """The time code to read: given, the start of the stage, or the earliest of each attribute."""
    if time is not None:
        return Usd.TimeCode(time)
    return Usd.TimeCode(stage.GetStartTimeCode()) if stage.HasAuthoredTimeCodeRange() else Usd.TimeCode.EarliestTime()


def to_y_up(stage):
    """Rotation of the stage's axes, for column vectors."""
    if UsdGeom.GetStageUpAxis(stage) != UsdGeom.Tokens.z:
        return np.eye(4)
    return np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], float)


def pose_skins(stage, time):
    """Replaces the points of skinned meshes by those of their pose at a time."""
    roots = [prim for prim in stage.Traverse() if prim.IsA(UsdSkel.Root)]
    code = stage.GetStartTimeCode() if time.IsEarliestTime() else time.GetValue()
    for prim in stage.Traverse() if roots else []:
        animation = UsdSkel.Animation(prim)
        if not animation:
            continue
        for attribute in (animation.GetTranslationsAttr(), animation.GetRotationsAttr(), animation.GetScalesAttr(),
                          animation.GetBlendShapeWeightsAttr()):
            if attribute.ValueMightBeTimeVarying():
                attribute.Set(attribute.Get(code), code)  # the only sample: baking reads samples alone
    for root in roots:
        UsdSkel.BakeSkinning(UsdSkel.Root(root), Gf.Interval(code, code))


def is_hidden(prim, time):
    """Invisible, or for another purpose than a final image; so are its children."""
    imageable = UsdGeom.Imageable(prim)
    if not imageable:
        return False
    is_invisible = imageable.GetVisibilityAttr().Get(time) == UsdGeom.Tokens.invisible
    return is_invisible or imageable.ComputePurpose() in (UsdGeom.Tokens.proxy, UsdGeom.Tokens.guide)


class PrimWalk:
    """All visible prims with their transforms, instances included."""

    def __init__(self, stage, file, time):
        self.stage, self.file, self.time = stage, file, time
        self.cache = UsdGeom.XformCache(time)

    def run(self):
        """Pairs of a prim and its transform to the stage, for column vectors."""
        for prim, matrix in self._below(self.stage.GetPseudoRoot(), Gf.Matrix4d(1)):
            yield prim, np.array(matrix).T

    def _below(self, root, base):
        """base: from the space of the root to the stage; the root's own transform is part of it."""
        prims = iter(Usd.PrimRange(root, VISITED))
        for prim in prims:
            if is_hidden(prim, self.time):
                prims.PruneChildren()
                continue
            matrix = base if prim == root else self.cache.ComputeRelativeTransform(prim, root)[0] * base
            if prim.IsA(UsdGeom.PointInstancer):
                prims.PruneChildren()
                yield from self._instances(UsdGeom.PointInstancer(prim), matrix)
            else:
                yield prim, matrix

    def _instances(self, instancer, to_stage):
        prim = instancer.GetPrim()
        numbers = instancer.GetProtoIndicesAttr().Get(self.time) or []
        if len(numbers) > MOST_INSTANCES:
            raise UsdError(self.file, prim.GetPath(), f"has {len(numbers)} instances, expected at most {MOST_INSTANCES}")
        matrices = instancer.ComputeInstanceTransformsAtTime(
            self.time, self.time, UsdGeom.PointInstancer.IncludeProtoXform, UsdGeom.PointInstancer.IgnoreMask)
        if len(matrices) != len(numbers):
            raise UsdError(self.file, prim.GetPath(), f"has {len(numbers)} protoIndices, but {len(matrices)} transforms")
        mask = instancer.ComputeMaskAtTime(self.time)
        prototypes = [self.stage.GetPrimAtPath(path) for path in instancer.GetPrototypesRel().GetForwardedTargets()]
        for index, (number, matrix) in enumerate(zip(numbers, matrices)):
            if not 0 <= number < len(prototypes) or not prototypes[number]:
                raise UsdError(self.file, prim.GetPath(),
                               f"protoIndices[{index}] is {number}, expected 0 to {len(prototypes) - 1}")
            if not mask or mask[index]:
                yield from self._below(prototypes[number], matrix * to_stage)
