#pragma once

#include "filters/channels.h"
#include "filters/grid/grid_band.h"
#include "filters/grid/grid_compress.h"

/// The filters of triangular grids for functions on the surface: colours, quality and custom attributes of the vertices
/// are samples on the lattice like heights. The shape stays as it is.
namespace multires {

struct GridAttributeBandOptions {
    AttributeChoice what;       ///< all but texture coordinates of the faces' corners
    bool linear_light = false;  ///< see AttributeRelaxationOptions
    GridBandOptions band;       ///< its relative_to and grid.channels do not count
};

/// grid_band() for attributes. A constant stays exactly as it is; colours are clamped to 0..255, at the end.
/// @throws InputError  for a mesh that is no triangular grid, limits and gains, and as vertex_channels()
/// Cost: linear.
Result grid_attributes_band(const Layer& layer, const GridAttributeBandOptions& options, Session& session);

struct GridAttributeCompressOptions {
    AttributeChoice what;
    bool linear_light = false;
    GridCompressOptions compress;  ///< the error is in units of the attribute; grid.channels does not count
};

/// A useful error for the attributes that are chosen without a choice: a hundredth of the range of the first; 1
/// without.
double default_attribute_error(const Layer* layer);

/// grid_compress() for attributes; the channels of a colour share their coefficients. Reports the same for each
/// attribute.
/// @throws InputError  for a mesh that is no triangular grid, options out of range, and as vertex_channels()
/// Cost: see sparse().
Result grid_attributes_compress(const Layer& layer, const GridAttributeCompressOptions& options, Session& session);

}  // namespace multires
