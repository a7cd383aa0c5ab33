#pragma once

#include "stream/bit_model.h"
#include "stream/star_mesh.h"

#include <array>
#include <vector>

namespace multires::stream {

/// A star and what can be told from its shape about the fans in it. Stars are taken once and used for all questions.
struct StarShape {
    struct Spoke {
        Vec3 ray;  ///< from the vertex to the spoke's
        double square = 0, length = 0;
        double cotangent = 0;  ///< sum of those of the opposite angles; negative: not Delaunay
        double bend = 0;       ///< 1 - cos of the angle between the two faces' normals
        double area_to = 0;    ///< sum of the areas of the faces before it
        int valence = 0;       ///< of the spoke's vertex, 11 at most
    };
    Star star;
    std::vector<std::uint8_t> taken;  ///< #faces: belongs to a vertex that was split off in this batch
    std::vector<Spoke> spokes;        ///< one more than faces
    double total = 0;                 ///< area
    Index faces_taken = 0;

    /// The star of u and what is taken.
    /// @param batch  the mark of faces that are taken
    void take(const StarMesh& mesh, Index u, Index batch);
    /// The rest.
    void measure(const StarMesh& mesh, Index u);
    bool has_fans() const { return !star.closed || faces_taken < star.faces(); }
};

/// Which fan of a star is split off: all fans are ranked by a log-linear model over what makes one likely, learned
/// on the way, and the rank is coded.
class FanModel {
public:
    /// @param first_models  of versions 1 and 2 of the file, which do not ask how near the new vertex is to its parent
    explicit FanModel(bool first_models);

    /// Ranks the fans of a star.
    void rank(const StarShape& shape);
    /// ln of the weight of the likeliest fan; with the first models of the sum of all.
    double evidence() const { return evidence_; }

    /// Codes which, after rank(), and learns.
    /// @throws InputError  if what is read is no fan
    Fan code(BitCoder& coder, const StarShape& shape, const Fan& fan);

private:
    static constexpr int most_faces = 6, features = 8;
    struct Candidate {
        Fan fan;
        std::array<int, features> weight;  ///< places in weights_
    };

    /// Sums over the edges inside a fan, from the first to the last: the order of sums is part of the format.
    struct Inner {
        double length = 0, cotangent = 0, bend = 0, squares = 0;
        Vec3 sum{0, 0, 0};
        void add(const StarShape::Spoke& s) {
            length += s.length, cotangent += s.cotangent, bend += s.bend;
            sum += s.ray, squares += s.square;
        }
    };
    void add(const StarShape& shape, const Fan& fan, const Inner& inner);
    void find_shares();
    Fan code_plainly(BitCoder& coder, const StarShape& shape, const Fan& fan);
    std::size_t code_rank(BitCoder& coder, std::size_t wanted);
    void learn(std::size_t chosen);

    std::size_t count_ = 0;              ///< of the fans that are ranked: the first ones of what follows
    std::vector<Candidate> candidates_;  ///< as long as they ever were
    std::vector<double> score_;          ///< the same
    std::vector<double> share_;          ///< #count_: of sum_ until code() divides them
    double sum_ = 0;
    std::vector<double> unranked_;  ///< shares of what is not ranked yet; -1: it is
    double evidence_ = 0;
    bool first_models_;
    std::vector<double> weights_, squares_;
    BitModel<4> is_it_;
};

}  // namespace multires::stream
