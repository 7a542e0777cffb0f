# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles of polygons."""
import numpy as np


def normals_of(corners):
    """Area vectors of polygons (Newell), m x 3, of corner positions m x n x 3."""
    return np.cross(corners, np.roll(corners, -1, axis=1)).sum(axis=1)


def are_convex(corners):
    """For each polygon of m x n x 3 positions: no corner is reflex."""
    ahead, behind = np.roll(corners, -1, axis=1) - corners, corners - np.roll(corners, 1, axis=1)
    turns = np.einsum("mnk,mk->mn", np.cross(behind, ahead), normals_of(corners))
    return (turns >= 0).all(axis=1)


def cut_ears(points):
    """Triangles of one polygon, n x 3 positions, as corner numbers (n - 2) x 3."""
    normal = normals_of(points[None])[0]
    axes = [axis for axis in range(3) if axis != np.argmax(np.abs(normal))]
    flat = points[:, axes] * [1, 1 if np.cross(*np.eye(3)[axes]) @ normal > 0 else -1]

    def turn(a, b, c):
        u, v = flat[b] - flat[a], flat[c] - flat[a]
        return u[0] * v[1] - u[1] * v[0]

    def is_ear(a, b, c, rest):
        return turn(a, b, c) > 0 and not any(
            min(turn(a, b, p), turn(b, c, p), turn(c, a, p)) >= 0 for p in rest if p not in (a, b, c))

    left, triangles = list(range(len(points))), []
    while len(left) > 3:
        count = len(left)
        corners = [(left[i - 1], left[i], left[(i + 1) % count]) for i in range(count)]
        ear = next((i for i in range(count) if is_ear(*corners[i], left)), 1)  # a degenerate polygon is a fan
        triangles.append(corners[ear])
        del left[ear]
    return np.array([*triangles, left])


def triangulate(points, counts, vertices):
    """Corners of triangles (t x 3, counted over all faces) and the face of each, without those of no area."""
    starts = np.cumsum(counts) - counts
    corners, faces = [np.empty((0, 3), int)], [np.empty(0, int)]
    for count in np.unique(counts[counts > 2]):
        group = np.flatnonzero(counts == count)
        own = starts[group, None] + np.arange(count)
        fan = np.stack([np.zeros(count - 2, int), np.arange(1, count - 1), np.arange(2, count)], axis=1)
        cut = np.broadcast_to(fan, (len(group), count - 2, 3)).copy()
        if count > 3:
            places = points[vertices[own]].astype(float)
            for i in np.flatnonzero(~are_convex(places)):
                cut[i] = cut_ears(places[i])
        corners.append(np.take_along_axis(own[:, None, :], cut.reshape(len(group), 1, -1), axis=2).reshape(-1, 3))
        faces.append(np.repeat(group, count - 2))
    corners, faces = np.concatenate(corners), np.concatenate(faces)
    a, b, c = points[vertices[corners]].transpose(1, 0, 2)
    has_area = np.cross(b - a, c - a).any(axis=1)
    order = np.argsort(faces[has_area], kind="stable")
    return corners[has_area][order], faces[has_area][order]


def vertex_normals(points, triangles):
    """Unit normals of vertices by the area of their triangles."""
    areas = np.cross(points[triangles[:, 1]] - points[triangles[:, 0]], points[triangles[:, 2]] - points[triangles[:, 0]])
    sums = np.stack([np.bincount(triangles.ravel(), np.repeat(areas[:, axis], 3), len(points)) for axis in range(3)], axis=1)
    return unit_rows(sums)


def unit_rows(vectors):
    """Rows of length 1; zero rows become y."""
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.where(lengths > 0, vectors / np.where(lengths > 0, lengths, 1), [0, 1, 0])
