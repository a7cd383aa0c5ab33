"""Denoising filters of the literature, to compare with: short, in numpy and scipy, written from the papers.

Vertices are #V by 3, faces #F by 3. Each function gives new vertices. Mean angles on the noisy pairs fandisk,
sharpsphere, nicolo and trimstar with the best of a few settings, and figures of others for them: bilateral normals 3.6,
6.8, 5.8, 6.4 (3.5, 8.3, 7.2, 6.5), guided normals 2.8, 6.3, 7.1, 6.6 (2.9, 8.2, 7.8, 7.4), L0 on the first and the last
2.7 and 6.3.
"""

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg

from measuring import edge_length


class Faces:
    """What the filters of normals need to know of the connectivity."""

    def __init__(self, v, f):
        self.f, self.count, rows = f, len(v), np.repeat(np.arange(len(f)), 3)
        self.at = sparse.csr_matrix((np.ones(3 * len(f)), (f.ravel(), rows)), shape=(len(v), len(f)))
        self.degree = np.maximum(self.at.sum(axis=1).A1, 1)
        near = (self.at.T @ self.at).tocoo()  # faces with a common vertex, themselves included
        self.i, self.j = near.row, near.col
        self.share_edge = near.data == 2

    def geometry(self, v):
        """Centroids, areas and unit normals."""
        n = np.cross(v[self.f[:, 1]] - v[self.f[:, 0]], v[self.f[:, 2]] - v[self.f[:, 0]])
        area = np.linalg.norm(n, axis=1)
        return v[self.f].mean(axis=1), area / 2, n / np.maximum(area, 1e-300)[:, None]

    def fit(self, v, normal, steps):
        """Vertices follow the normals (Sun et al. 2007, eq. 9)."""
        for _ in range(steps):
            center = v[self.f].mean(axis=1)
            along = np.einsum("ij,ij->i", normal, center)
            pull = self.at @ (normal * along[:, None])
            outer = (self.at @ np.einsum("ij,ik->ijk", normal, normal).reshape(-1, 9)).reshape(-1, 3, 3)
            v = v + (pull - np.einsum("ijk,ik->ij", outer, v)) / self.degree[:, None]
        return v

    def mean(self, weight, normal):
        """Unit weighted means over the neighbours of each face."""
        sums = np.stack([np.bincount(self.i, weight * normal[self.j, c], len(self.f)) for c in range(3)], axis=1)
        return sums / np.maximum(np.linalg.norm(sums, axis=1), 1e-300)[:, None]


def unit_gauss(x, deviation):
    return np.exp(-np.square(x) / (2 * deviation**2))


def bilateral_normals(v, f, tolerance, steps, fits=10):
    """Zheng, Fu, Au, Tai, "Bilateral Normal Filtering for Mesh Denoising", TVCG 2011: the local, iterative scheme.
    tolerance: deviation of the weights over differences of unit normals."""
    faces = Faces(v, f)
    center, area, normal = faces.geometry(v)
    apart = np.linalg.norm(center[faces.i] - center[faces.j], axis=1)
    near = area[faces.j] * unit_gauss(apart, apart[faces.i != faces.j].mean())
    for _ in range(steps):
        differ = np.linalg.norm(normal[faces.i] - normal[faces.j], axis=1)
        normal = faces.mean(near * unit_gauss(differ, tolerance), normal)
    return faces.fit(v, normal, fits)


def guided_normals(v, f, tolerance, steps, fits=10):
    """Zhang, Deng, Zhang, Bouaziz, Liu, "Guided Mesh Normal Filtering", PGF 2015: joint bilateral filtering, guided by
    the mean normal of the most consistent patch around each face. Patches are the faces with a common vertex."""
    faces = Faces(v, f)
    edge = faces.share_edge
    for _ in range(steps):
        center, area, normal = faces.geometry(v)
        differ = np.linalg.norm(normal[faces.i] - normal[faces.j], axis=1)
        # Of the patch of each face: how far its normals lie apart, and how much of that is in one edge.
        spread = np.zeros(len(f))
        np.maximum.at(spread, faces.i, differ)
        salient, sums = np.zeros(len(f)), np.zeros(len(f))
        most = np.zeros(len(f))
        np.maximum.at(most, faces.i[edge], differ[edge])
        np.maximum.at(salient, faces.i, most[faces.j])
        per_face = np.bincount(faces.i[edge], differ[edge], len(f))
        sums = np.bincount(faces.i, per_face[faces.j], len(f))
        roughness = spread * salient / (1e-9 + sums)
        mean = faces.mean(area[faces.j], normal)
        # The patch with the least of it, among those that hold the face.
        order = np.lexsort((roughness[faces.j], faces.i))
        first = np.unique(faces.i[order], return_index=True)[1]
        guide = mean[faces.j[order][first]]
        apart = np.linalg.norm(center[faces.i] - center[faces.j], axis=1)
        near = area[faces.j] * unit_gauss(apart, apart[faces.i != faces.j].mean())
        alike = unit_gauss(np.linalg.norm(guide[faces.i] - guide[faces.j], axis=1), tolerance)
        v = faces.fit(v, faces.mean(near * alike, normal), fits)
    return v


def l0(v, f, smoothness):
    """He, Schaefer, "Mesh Denoising via L0 Minimization", SIGGRAPH 2013: the edge operator weighted by areas, with the
    regularisation. smoothness: factor for their lambda."""
    quads = hinges(f)
    size = edge_length(v, f)
    noisy, p = v / size, v / size
    _, angle = edge_operator(p, quads)
    start = angle.mean()
    weight, rough = 0.02 * smoothness * start, 0.1 * start
    beta = 1e-3
    rows = np.repeat(np.arange(len(quads)), 4)
    regular = sparse.csr_matrix((np.tile([1.0, -1, 1, -1], len(quads)), (rows, quads.ravel())), (len(quads), len(v)))
    while beta < 1e3:
        factors, _ = edge_operator(p, quads)
        d = sparse.csr_matrix((factors.ravel(), (rows, quads.ravel())), (len(quads), len(v)))
        wanted = d @ p
        wanted[np.square(wanted).sum(axis=1) < weight / beta] = 0
        system = sparse.identity(len(v)) + beta * d.T @ d + rough * regular.T @ regular
        right = noisy + beta * d.T @ wanted
        solver = scipy.sparse.linalg.splu(system.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
        p = solver.solve(right)
        beta *= 2**0.5
        rough /= 2
    return p * size


def hinges(f):
    """Of each edge with two faces, 4 vertices: an end, the opposite one, the other end, the other opposite one."""
    start, end, opposite = f.ravel(), np.roll(f, -1, axis=1).ravel(), np.roll(f, -2, axis=1).ravel()
    key = np.minimum(start, end).astype(np.int64) * (f.max() + 1) + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    same = np.flatnonzero(key[order][:-1] == key[order][1:])
    a, b = order[same], order[same + 1]
    return np.stack([start[a], opposite[a], end[a], opposite[b]], axis=1)


def edge_operator(p, quads):
    """(#edges by 4 factors, eq. 7: they cancel where the quadrilateral is flat; angle between the two normals)."""
    p1, p2, p3, p4 = (p[quads[:, k]] for k in range(4))
    n1, n2 = np.cross(p2 - p1, p3 - p1), np.cross(p3 - p1, p4 - p1)
    a, b = (np.maximum(np.linalg.norm(n, axis=1), 1e-12) / 2 for n in (n1, n2))
    dot = lambda x, y: np.einsum("ij,ij->i", x, y)  # noqa: E731
    square = np.maximum(dot(p3 - p1, p3 - p1), 1e-12) * (a + b)
    factors = [(a * dot(p4 - p3, p3 - p1) + b * dot(p1 - p3, p3 - p2)) / square, b / (a + b),
               (a * dot(p3 - p1, p1 - p4) + b * dot(p2 - p1, p1 - p3)) / square, a / (a + b)]  # fmt: skip
    cosine = dot(n1, n2) / (4 * a * b)
    return np.stack(factors, axis=1), np.arccos(np.clip(cosine, -1, 1))
