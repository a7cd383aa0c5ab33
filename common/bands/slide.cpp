#include "bands/slide.h"

#include "bands/directions.h"
#include "bands/spline.h"
#include "base/parallel.h"
#include "measure/distance.h"
#include "measure/vertex_normals.h"
#include "mesh/incidence.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace multires {
namespace {

constexpr double low_enough = 0.05;   ///< drift that is left alone, of the RMS way along the normals
constexpr double small_way = 0.1;     ///< what a vertex may be off its normal in the result, of the same
constexpr double least_cosine = 0.5;  ///< between faces and the low-passed surface, and between neighbours
constexpr double least_gain = 1e-3;   ///< of the sum
constexpr int most_rounds = 15;
constexpr Index most_faces = 500;  ///< around a vertex: others stay, count for nothing, and no walk goes over them

Vec3 unit(const Vec3& v) {
    const double length = v.norm();
    return length > 0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

/// A surface with a normal at each vertex, blended over faces, on which the point nearest to another is found by
/// walking from a vertex not far from it.
class Ground {
public:
    Ground(const Faces& faces, const Positions& p, const Incidence& incident)
        : faces_(faces), p_(p), incident_(incident), normal_(vertex_normals(faces, p)) {}

    struct Place {
        Index vertex = -1;  ///< near the point: where to start from next time
        Vec3 normal = Vec3::Zero();
    };

    /// The nearest point that can be reached downhill from a vertex.
    Place at(const Vec3& q, Index from) const {
        Hit best{(p_[from] - q).squaredNorm(), -1, p_[from]};
        for (int step = 0; step < most_steps && nearer(q, from, best); ++step) from = nearest_corner(best);
        return {from, best.face < 0 ? normal_[from] : blend(best)};
    }

private:
    static constexpr int most_steps = 200;
    using Hit = SurfaceTree::Hit;

    /// Looks at the faces around a vertex, and where those have nothing nearer, around the other corners of the last.
    bool nearer(const Vec3& q, Index vertex, Hit& best) const {
        if (around(q, vertex, best)) return true;
        if (best.face < 0) return false;
        bool found = false;
        const Face last = faces_[best.face];
        for (const Index v : last) found = (v != vertex && around(q, v, best)) || found;
        return found;
    }
    bool around(const Vec3& q, Index vertex, Hit& best) const {
        bool found = false;
        if (best.face >= 0 && incident_[vertex].size() > most_faces) return false;
        for (const Index i : incident_[vertex]) {
            const Face& f = faces_[i];
            const Vec3 c = closest_on_triangle(q, p_[f[0]], p_[f[1]], p_[f[2]]);
            const double squared = (c - q).squaredNorm();
            if (squared < best.squared * (1 - 1e-12)) best = {squared, i, c}, found = true;
        }
        return found;
    }
    Index nearest_corner(const Hit& hit) const {
        const Face& f = faces_[hit.face];
        return *std::min_element(f.begin(), f.end(), [&](Index a, Index b) {
            return (p_[a] - hit.point).squaredNorm() < (p_[b] - hit.point).squaredNorm();
        });
    }
    Vec3 blend(const Hit& hit) const {
        const Face& f = faces_[hit.face];
        const Vec3 area = area_vector(f, p_);
        if (!(area.squaredNorm() > 0)) return normal_[f[0]];
        Vec3 sum = Vec3::Zero();
        for (int k = 0; k < 3; ++k) {
            const Vec3 &a = p_[f[(k + 1) % 3]], &b = p_[f[(k + 2) % 3]];
            sum += area.dot((b - a).cross(hit.point - a)) * normal_[f[k]];
        }
        return unit(sum);
    }

    const Faces& faces_;
    const Positions& p_;
    const Incidence& incident_;
    Array<Vec3> normal_;
};

class Slide {
    using Place = Ground::Place;

public:
    Slide(const Mesh& mesh, const Stiffness& neighbours, const Positions& smooth, Positions& moved)
        : mesh_(mesh), near_(neighbours), moved_(moved),
          incident_(vertex_faces(mesh.faces, static_cast<Index>(moved.size()))), ground_(mesh.faces, smooth, incident_),
          place_(moved.size()), area_(moved.size(), 0), counts_(moved.size()) {
        parallel_for(static_cast<Index>(moved.size()), [&](Index i) { counts_[i] = simple(i); });
        for (const Face& f : mesh.faces) {
            const double area = area_vector(f, moved).norm();
            for (const Index v : f) area_[v] += area;
        }
    }

    void run(double small) {
        std::vector<std::uint8_t> live(moved_.size(), 1), next(moved_.size());
        for (int round = 0; round < most_rounds; ++round) {
            bool any = false;
            std::fill(next.begin(), next.end(), 0);
            for (Index v = 0; v < static_cast<Index>(moved_.size()); ++v) {
                if (!live[v] || !step(v, small)) continue;
                any = true;
                next[v] = 1;
                for (Index k = near_.offset[v]; k < near_.offset[v + 1]; ++k) next[near_.column[k]] = 1;
            }
            if (!any) return;
            live.swap(next);
        }
    }

private:
    /// Whether the faces of a vertex agree on a side: taken as they are, they do not cancel where turned to agree they
    /// would not.
    bool simple(Index v) const {
        const auto faces = incident_[v];
        if (faces.size() == 0 || faces.size() > most_faces) return false;
        Vec3 sum = Vec3::Zero(), agreeing = Vec3::Zero();
        for (const Index i : faces) {
            const Vec3 area = area_vector(mesh_.faces[i], mesh_.positions);
            sum += area;
            agreeing += agreeing.dot(area) < 0 ? Vec3(-area) : area;
        }
        return sum.squaredNorm() >= 0.25 * agreeing.squaredNorm();
    }

    /// One vertex, by the whole way back, half of it, or a fifth.
    bool step(Index v, double small) {
        if (!counts_[v]) return false;
        const Vec3 way = moved_[v] - mesh_.positions[v], own = normal_of(v);
        if ((way - own.dot(way) * own).squaredNorm() <= small * small || place(v).normal.isZero()) return false;
        const Vec3 sum = own + place(v).normal, normal = sum.squaredNorm() > 0.01 ? unit(sum) : place(v).normal;
        const Vec3 along = way - normal.dot(way) * normal;
        const Vec3 from = moved_[v];
        const Place before_it = place_[v];
        turns_around(v, turn_before_);
        const double before = cost_around(v);
        for (const double share : {1.0, 0.5, 0.2}) {
            moved_[v] = from - share * along;
            place_[v] = ground_.at(moved_[v], before_it.vertex);
            if (faces_lie(v) && cost_around(v) < (1 - least_gain) * before) return true;
        }
        moved_[v] = from, place_[v] = before_it;
        return false;
    }

    /// Found when it is first asked for: most vertices lie well and far from those that do not.
    const Place& place(Index v) {
        if (place_[v].vertex < 0) place_[v] = ground_.at(moved_[v], v);
        return place_[v];
    }
    /// Whether no face around a vertex leans too far, unless it did before.
    bool faces_lie(Index v) {
        turns_around(v, turn_);
        for (std::size_t k = 0; k < turn_.size(); ++k)
            if (turn_[k] < least_cosine && turn_[k] < turn_before_[k] - 1e-9) return false;
        return true;
    }
    /// Cosines between the faces around a vertex and the low-passed surface there, and their neighbours.
    void turns_around(Index v, std::vector<double>& turn) {
        turn.clear();
        for (const Index i : incident_[v]) {
            const Face& f = mesh_.faces[i];
            const Vec3 area = area_vector(f, moved_);
            turn.push_back(cosine(area, place(f[0]).normal + place(f[1]).normal + place(f[2]).normal));
            for (int k = 0; k < 3; ++k)
                if (const Index j = across(i, f[k], f[(k + 1) % 3]); j >= 0)
                    turn.push_back(cosine(area, area_vector(mesh_.faces[j], moved_)));
        }
    }
    /// The face on the other side of an edge a, b; -1 if there is not exactly one.
    Index across(Index face, Index a, Index b) const {
        Index found = -1;
        for (const Index i : incident_[a]) {
            const Face& f = mesh_.faces[i];
            if (i == face || std::find(f.begin(), f.end(), b) == f.end()) continue;
            if (found >= 0) return -1;
            found = i;
        }
        return found;
    }
    static double cosine(const Vec3& a, const Vec3& b) {
        const double lengths = a.norm() * b.norm();
        return lengths > 0 ? a.dot(b) / lengths : -2;
    }
    Vec3 normal_of(Index v) const {
        Vec3 sum = Vec3::Zero();
        for (const Index i : incident_[v]) sum += area_vector(mesh_.faces[i], moved_);
        return unit(sum);
    }
    double cost(Index v) {
        if (!counts_[v]) return 0;
        const Vec3 way = moved_[v] - mesh_.positions[v];
        const double a = normal_of(v).dot(way), b = place(v).normal.dot(way);
        return area_[v] * (2 * way.squaredNorm() - a * a - b * b);
    }
    double cost_around(Index v) {
        double sum = cost(v);
        for (Index k = near_.offset[v]; k < near_.offset[v + 1]; ++k) sum += cost(near_.column[k]);
        return sum;
    }

    const Mesh& mesh_;
    const Stiffness& near_;
    Positions& moved_;
    Incidence incident_;
    Ground ground_;
    Array<Place> place_;
    Array<double> area_;
    Array<std::uint8_t> counts_;
    std::vector<double> turn_before_, turn_;  ///< around the vertex at hand, before its step and after
};

}  // namespace

void slide_back(const Mesh& mesh, const Stiffness& neighbours, const Positions& smooth, Positions& moved) {
    const Drift now = drift(mesh.faces, mesh.positions, moved);
    if (now.tangential_rms <= low_enough * now.normal_rms) return;
    Slide slide(mesh, neighbours, smooth, moved);
    slide.run(small_way * now.normal_rms);
}

}  // namespace multires
