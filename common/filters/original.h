#pragma once

#include "filters/filter.h"
#include "mesh/shape_hash.h"

#include <optional>

/// Non-destructive filtering: the shape a mesh had before any of these filters moved it is kept with it, and filters
/// can start from there again instead of from their own earlier results.
namespace multires {

/// What shape a filter starts from.
enum class RelativeTo {
    current,   ///< the mesh as it is
    original,  ///< as it was before filters of this suite first moved it
};

/// The original of a mesh, and every shape that filters of this suite made of it. Immutable; copies share the
/// positions.
///
/// A shape belongs to the original if it is, bit for bit, one that was noted: any other change of positions or faces
/// in between, even by another plugin, is thus noticed, and one that was taken back does not
/// count.
class Original {
public:
    explicit Original(const Mesh& mesh);

    const Positions& positions() const { return *positions_; }  ///< #V by 3
    bool includes(const Mesh& mesh) const;

    /// Notes a result: new positions with the original's faces.
    void note(const Positions& result, const Faces& faces);

private:
    std::shared_ptr<const Positions> positions_;
    std::vector<ContentHash> shapes_;  ///< the original's own comes first
};

/// What is to be kept with a mesh whose positions change from those of `before` to `after`, as the host stores them:
/// `kept` if it includes `before`, otherwise `before` is the new original.
std::shared_ptr<const Original> original_after(const Original* kept, const Mesh& before, const Positions& after);

/// The layer a filter computes on: the one it was given, or a copy with the original's positions. Selection, attributes
/// and marks of edges are always those of the given layer.
class Start {
public:
    /// A mesh without an original is its own; the report says so if the original is asked for.
    /// @throws InputError if it is, and the mesh was changed by something else since
    Start(const Layer& layer, RelativeTo relative_to, const Session& session, Report& report);

    const Layer& layer() const { return copy_ ? *copy_ : given_; }

private:
    const Layer& given_;
    std::optional<Layer> copy_;
};

}  // namespace multires
