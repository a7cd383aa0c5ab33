#pragma once

#include "filters/filter.h"
#include "schemes/scheme.h"

#include <string>
#include <vector>

/// Attributes as numbers to compute with: which ones a filter takes, in which space, and how they go back.
namespace multires {

/// Which attributes a filter works on. Those asked for must be there.
struct AttributeChoice {
    bool color = false;           ///< of vertices, with alpha
    bool quality = false;         ///< of vertices
    bool texcoord = false;        ///< of vertices
    bool wedge_texcoord = false;  ///< of the faces' corners
    bool custom = false;          ///< custom scalars and points of vertices
    std::string custom_names;     ///< for `custom`: names separated by commas; empty: all but "source_vertex"
};

/// The first of color, quality, wedge_texcoord, texcoord and custom that is not the same at every vertex; if all are,
/// the first that the layer has; color if it has none.
/// Cost: linear
AttributeChoice default_choice(const Layer* layer);

/// The vertex attributes chosen, as indices into Layer::attributes.
/// @throws InputError  naming the parameter if nothing is chosen or the layer lacks what is
std::vector<std::size_t> chosen_attributes(const Layer& layer, const AttributeChoice& choice);

/// One attribute of the vertices, ready for a transform.
struct Channels {
    std::string label;          ///< the parameter that asked for it, and the head of its keys in a report
    std::size_t attribute = 0;  ///< index into Layer::attributes
    bool linear_light = false;  ///< red, green and blue of `field` were decoded, see decode_light()
    Field field;                ///< #V by width, in order of the input; Field::has_positions is false
};

/// The vertex attributes chosen.
/// @param linear_light  decode colours
/// @throws InputError  naming the parameter if nothing is chosen or the layer lacks what is; naming the attribute and
///                     the vertex if a value is not finite or too large to be squared
std::vector<Channels> vertex_channels(const Layer& layer, const AttributeChoice& choice, bool linear_light);

/// Colours, quality and custom scalars and points of the vertices, as they are stored, but for those with a value that
/// is not finite or too large to be squared: what follows a shape where nothing was chosen.
std::vector<Channels> usable_channels(const Layer& layer);

/// Between the values of an image file (sRGB, IEC 61966-2-1) and amounts of light, both in 0..255. Values outside are
/// continued steadily.
double decode_light(double value);
double encode_light(double light);

/// The attribute with new values, and how much it changed in the report (`label`_largest_change, `label`_rms_change, in
/// its own units; for colours of 255). Colours are clamped to 0..255; they are not rounded, which is for the host to
/// do, once. A row of `after` that equals that of `before` gives back exactly what the layer has.
/// @param after    #V by width, in the space of `before`
/// @param weights  #V shares of the change that each vertex gets, or empty: all 1
Attribute changed_attribute(const Layer& layer, const Channels& before, const Field& after,
                            const std::vector<double>& weights, Report& report);

}  // namespace multires
