#pragma once

#include "base/error.h"
#include "base/progress.h"
#include "base/report.h"
#include "filters/intermediate.h"
#include "mesh/layer.h"
#include "pyramid/cache.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// What every filter gets and gives. A filter is a pure function of a layer (or several) and its options: it returns a
/// Result and never touches the host's document, so that a failure or a cancel leaves everything as it was.
namespace multires {

/// What a filter wants changed. Absent parts stay as they are; the host writes all of it or nothing.
struct Result {
    std::optional<Positions> positions;          ///< #V by 3
    std::optional<std::vector<double>> quality;  ///< #V, becomes the vertex quality
    /// New values of attributes given in the layer; scalars and points that the mesh does not have yet are made.
    std::vector<Attribute> attributes;
    std::optional<std::vector<Wedge>> wedges;                  ///< 3 #F, new texture coordinates of the faces' corners
    std::optional<std::vector<std::uint8_t>> selected_vertex;  ///< #V, 0 or 1, becomes the vertex selection
    std::optional<std::vector<std::uint8_t>> selected_edges;   ///< #F, as in Layer, becomes the edge selection
    std::optional<DerivedMesh> layer;                          ///< becomes a new layer of the document
    Report report;
};

/// Names another layer in the options of a filter: its place in Inputs::others. Hosts fill it; empty: there is none.
struct LayerRef {
    std::optional<std::size_t> place;
};

/// The layers a filter works on. None of them changes but by way of the Result, which belongs to the current one.
struct Inputs {
    const Layer& current;
    std::vector<const Layer*> others = {};  ///< those that the options name; may be the current one itself

    /// @throws InputError  naming the parameter, if there is no other layer
    const Layer& other(const LayerRef& ref, const std::string& parameter) const {
        require(ref.place && *ref.place < others.size(), parameter + ": there is no other layer");
        return *others[*ref.place];
    }
};

class Original;
class Spline;

/// The part of a call that outlives it: progress, and what travels with the mesh.
struct Session {
    Progress progress;
    /// The pyramids kept with the layer by earlier calls of any of our plugins; some may be stale (their content hashes
    /// decide). A filter that builds one puts it here; the host keeps what is here with the mesh, whether the call
    /// succeeds or not: that is no change of the document.
    PyramidCache pyramids;
    /// What filters worked out for this layer before their sliders came in, kept in the same way.
    IntermediateCache intermediates;
    /// The systems of the calibrated filters (bands/spline.h), kept in the same way.
    std::shared_ptr<const Spline> spline;
    /// For filters that need much memory, both null or both there: empties the mesh of the current layer, and gives
    /// the place of its vertices all the same (several may be asked for at once).
    std::function<void()> let_mesh_go;
    std::function<Vec3(Index vertex)> position;
    /// The shape the layer had before an earlier call of any of our plugins first moved it; null if none did. The host
    /// keeps it up to date (see original.h).
    std::shared_ptr<const Original> original;
};

/// The session's pyramid that was built from this very layer with these options, or a new one (put into the session).
/// Before it is built, what the layer can no longer use is let go (see PyramidCache). Reports which:
/// pyramid_reused.
/// @throws InputError for a mesh without faces, with NaN, ... (see require_usable) or options out of range
std::shared_ptr<const Pyramid> pyramid_of(const Layer& layer, const PyramidOptions& options, Session& session,
                                          Report& report);
/// The same with a cache, and the progress of the whole.
std::shared_ptr<const Pyramid> pyramid_of(const Layer& layer, const PyramidOptions& options, PyramidCache& pyramids,
                                          const Progress& progress, Report& report,
                                          const std::function<void()>& layer_read = {});

}  // namespace multires
