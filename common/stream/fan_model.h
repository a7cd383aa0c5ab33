#pragma once

#include "stream/bit_model.h"
#include "stream/star_mesh.h"
#include "stream/two.h"

#include <array>
#include <vector>

namespace multires::stream {

/// A star and what can be told from its shape about the fans in it. Stars are taken once and used for all questions.
struct StarShape {
    /// What is known of each spoke, a column of numbers each.
    enum Column {
        x,  ///< of the ray from the vertex to the spoke's, as y and z
        y,
        z,
        square,  ///< of its length
        length,
        cotangent,  ///< sum of those of the opposite angles; negative: not Delaunay
        bend,       ///< 1 - cos of the angle between the two faces' normals
        area_to,    ///< sum of the areas of the faces before it
        turned,     ///< the total area from the second turn on, else 0
        valence,    ///< of the spoke's vertex, 11 at most
        columns
    };
    static constexpr Index overhang = 8;  ///< spokes of the second turn
    Star star;
    std::vector<std::uint8_t> taken;  ///< #faces: belongs to a vertex that was split off in this batch
    double total = 0;                 ///< area
    Index faces_taken = 0;

    /// The star of u and what is taken.
    /// @param batch  the mark of faces that are taken
    void take(const StarMesh& mesh, Index u, Index batch);
    /// The rest.
    void measure(const StarMesh& mesh, Index u);
    bool has_fans() const { return !star.closed || faces_taken < star.faces(); }

    /// One more than faces, and `overhang` more: of closed stars the first ones again, of others zeros.
    const double* operator[](Column c) const { return numbers_.data() + c * room_; }

private:
    enum FaceColumn { normal_x = columns, normal_y, normal_z, first_cotangent, second_cotangent, all_columns };
    double* column(int c) { return numbers_.data() + c * room_; }
    void measure_rays(const StarMesh& mesh, Index u);
    void measure_faces();
    void turn_again();

    std::vector<double> numbers_;  ///< by columns of room_
    std::size_t room_ = 0;
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
        std::size_t value;  ///< the first of its numbers in values_, which are every other one from there on
    };

    /// Sums over the edges inside two fans, from the first to the last: the order of sums is part of the format.
    struct Inner {
        Two length, cotangent, bend, squares, x, y, z;
        template <class Spokes>
        void add(const Spokes& at, Index spoke);
    };
    void rank_inside(const StarShape& shape);
    void rank_at_ends(const StarShape& shape);
    template <class Spokes>
    Two score(const StarShape& shape, const Spokes& at, Index faces, int kind, Inner& inner);
    void put(std::size_t at, const Fan& fan, double score, int which);
    void find_shares();
    Fan code_plainly(BitCoder& coder, const StarShape& shape, const Fan& fan);
    std::size_t code_rank(BitCoder& coder, std::size_t wanted);
    void learn(std::size_t chosen);

    std::size_t count_ = 0;              ///< of the fans that are ranked: the first ones of what follows
    std::vector<Candidate> candidates_;  ///< as long as they ever were
    std::vector<double> score_;          ///< the same
    std::vector<double> share_;          ///< #count_: of sum_ until code() divides them
    double sum_ = 0;
    std::vector<Index> most_faces_from_;  ///< #faces + 1: of fans that start there
    std::vector<std::int64_t> values_;    ///< of features, by two fans, of all fans
    std::size_t values_count_ = 0;
    std::vector<double> unranked_;  ///< shares of what is not ranked yet; -1: it is
    double evidence_ = 0;
    bool first_models_;
    std::vector<double> weights_, squares_;
    BitModel<4> is_it_;
};

}  // namespace multires::stream
