#include "filters/grid/grid_attributes.h"

#include "mesh/validation.h"

#include <algorithm>

namespace multires {

Result grid_attributes_band(const Layer& layer, const GridAttributeBandOptions& options, Session& session) {
    require_usable(layer.mesh);
    const GridBandOptions& band = options.band;
    const std::vector<Channels> all = vertex_channels(layer, options.what, options.linear_light);
    Result result;
    const std::vector<double> weights = region_weights(layer, band.region);
    session.progress.report(0, "Finding the grid");
    const FoundGrids found = grids_of(layer, band.grid);
    const std::vector<GridPyramid> pyramids = pyramids_of(found, band.grid);
    std::vector<std::vector<double>> gains;
    gains.reserve(pyramids.size());
    for (const GridPyramid& pyramid : pyramids) gains.push_back(grid_gains(band, pyramid, layer));
    for (std::size_t a = 0; a < all.size(); ++a) {
        session.progress.report(0.1 + 0.9 * static_cast<double>(a) / static_cast<double>(all.size()), "Transforming");
        Field after = all[a].field;
        for (std::size_t g = 0; g < pyramids.size(); ++g) {
            if (std::all_of(gains[g].begin(), gains[g].end(), [](double x) { return x == 1; })) continue;
            const GridSignal signal(found.grids[g], all[a].field);
            signal.add(change_by_gains(signal, pyramids[g], gains[g]), after);
        }
        result.attributes.push_back(changed_attribute(layer, all[a], after, weights, result.report));
    }
    result.report.add("grids", static_cast<int>(found.grids.size()));
    result.report.add("gains", gains[0]);
    return result;
}

double default_attribute_error(const Layer* layer) {
    if (!layer) return 1;
    const std::vector<Channels> all = usable_channels(*layer);
    if (all.empty()) return 1;
    const auto [least, most] = std::minmax_element(all[0].field.values.begin(), all[0].field.values.end());
    return *most > *least ? 0.01 * (*most - *least) : 1;
}

Result grid_attributes_compress(const Layer& layer, const GridAttributeCompressOptions& options, Session& session) {
    require_usable(layer.mesh);
    check(options.compress);
    const std::vector<Channels> all = vertex_channels(layer, options.what, options.linear_light);
    Result result;
    const std::vector<double> weights = region_weights(layer, options.compress.region);
    session.progress.report(0, "Finding the grid");
    const FoundGrids found = grids_of(layer, options.compress.grid);
    const std::vector<GridPyramid> pyramids = pyramids_of(found, options.compress.grid);
    const double shares = static_cast<double>(all.size() * layer.mesh.positions.size());
    double done = 0;
    for (const Channels& c : all) {
        Field after = c.field;
        CompressionErrors errors;
        for (std::size_t g = 0; g < pyramids.size(); ++g) {
            const Grid& grid = found.grids[g];
            const Progress part = session.progress.part(0.95 * done / shares, 0.95 * (done + grid.vertices) / shares);
            done += grid.vertices;
            const GridSignal signal(grid, c.field);
            signal.add(change_by_compression(signal, grid, pyramids[g], options.compress, part, errors), after);
        }
        const bool color = layer.attributes[c.attribute].kind == AttributeKind::color;
        errors.tell(c.label + "_", color ? "of 255" : "", result.report);
        result.attributes.push_back(changed_attribute(layer, c, after, weights, result.report));
    }
    return result;
}

}  // namespace multires
