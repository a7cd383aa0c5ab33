#include "filters/editing/bands.h"

#include "base/hash.h"
#include "mesh/validation.h"
#include "pyramid/pyramid.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace multires {
namespace {

void check(const BandsOptions& options, const Mesh& mesh) {
    require(options.bands >= 2 && options.bands <= most_bands, "bands must be 2 to " + std::to_string(most_bands));
    require(options.vertices >= 1 && static_cast<std::size_t>(options.vertices) <= mesh.positions.size(),
            "vertices must be 1 to " + std::to_string(mesh.positions.size()) + ", all that the mesh has");
    for (std::size_t k = 0; k < options.gain.size(); ++k)
        require(std::isfinite(options.gain[k]), "gain_" + std::to_string(k + 1) + " must be a number");
}

/// The bands of a shape, kept with the layer for other gains.
class PreparedBands final : public Intermediate {
public:
    PreparedBands(const ContentHash& hash, const ContentHash& shape, const Mesh& mesh, const Pyramid& pyramid,
                  std::vector<Index> counts, const Progress& progress)
        : Intermediate(hash, shape), kept(std::move(counts)),
          bands(multiband_of(mesh, pyramid, kept, nullptr, progress)) {}
    std::size_t bytes() const override { return sizeof *this + kept.capacity() * sizeof(Index) + bands.bytes(); }

    const std::vector<Index> kept;
    const Multiband bands;
};

std::shared_ptr<const PreparedBands> bands_of(const Layer& layer, const BandsOptions& options, Session& session,
                                              Report& report) {
    const Progress whole = session.progress;
    session.progress = whole.part(0, 0.2);
    const auto pyramid = pyramid_of(layer, options.pyramid, session, report);
    session.progress = whole;
    std::vector<Index> kept = kept_by_bases(*pyramid, options.levels, options.bands - 1,
                                            std::max<Index>(options.vertices, pyramid->hierarchy().size.back()));
    Hash hash;
    hash.add(std::array<int, 1>{static_cast<int>(IntermediateKind::bands)});
    hash.add(pyramid->hash());
    hash.add(kept);
    const ContentHash key = hash.bits128();
    return find_or_make<PreparedBands>(session.intermediates, key, pyramid->shape(), [&] {
        return std::make_shared<const PreparedBands>(key, pyramid->shape(), layer.mesh, *pyramid, std::move(kept),
                                                     whole.part(0.2, 0.9));
    });
}

}  // namespace

void report_bands(const Multiband& bands, const std::vector<Index>& kept, Report& report) {
    std::vector<double> details;
    for (std::size_t k = 0; k < bands.bands(); ++k) details.push_back(bands.rms_detail(k));
    report.add("vertices_kept", std::vector<double>(kept.begin(), kept.end()));
    report.add("band_detail", details, "mesh units");
    report.add("border_points", static_cast<int>(bands.border()));
    report.add("nearest_points", static_cast<int>(bands.nearest()));
}

Result apply_bands(const Layer& layer, const BandsOptions& options, Session& session) {
    require_usable(layer.mesh);
    check(options, layer.mesh);
    const std::vector<double> weights = region_weights(layer, options.region);
    Result result;
    const Start start(layer, options.relative_to, session, result.report);
    const Mesh& mesh = start.layer().mesh;
    const Progress whole = session.progress;
    const auto prepared = bands_of(start.layer(), options, session, result.report);
    const Multiband& bands = prepared->bands;
    report_bands(bands, prepared->kept, result.report);
    const std::vector<double> gain(options.gain.begin(), options.gain.begin() + options.bands - 1);
    const bool same = std::all_of(gain.begin(), gain.end(), [](double g) { return g == 1; });
    Positions after = same ? mesh.positions : bands.reconstruct(mesh.faces, bands.coarsest(), gain);
    whole.report(0.95, "Measuring the change");
    blend(layer.mesh.positions, weights, after);
    report_change(layer, after, result.report);
    result.positions = std::move(after);
    return result;
}

}  // namespace multires
