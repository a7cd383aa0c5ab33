#pragma once

#include "base/content_cache.h"
#include "mesh/shape_hash.h"

#include <cstddef>
#include <memory>

/// What a filter solves for before its sliders come in, kept with the mesh for the next call: a preview then takes as
/// long as the rest of the work.
namespace multires {

/// The base of what is kept, immutable. Its content hash begins with a number of the kind (see IntermediateKind), so
/// whoever finds one knows which class it is.
class Intermediate {
public:
    /// @param hash   of the kind and all that it depends on
    /// @param shape  shape_hash() of the layer
    Intermediate(const ContentHash& hash, const ContentHash& shape) : hash_(hash), shape_(shape) {}
    Intermediate(const Intermediate&) = delete;
    Intermediate& operator=(const Intermediate&) = delete;
    virtual ~Intermediate() = default;

    const ContentHash& hash() const { return hash_; }
    const ContentHash& shape() const { return shape_; }
    /// Memory it holds.
    virtual std::size_t bytes() const = 0;

private:
    ContentHash hash_, shape_;
};

enum class IntermediateKind : unsigned char { followed_edit = 1, fine_detail, bands, moved_region };

using IntermediateCache = ContentCache<Intermediate>;

/// The one with this content hash, or a new one that make() gives, put into the cache.
/// @tparam T  the class of the kind that the hash begins with
template <class T, class Make>
std::shared_ptr<const T> find_or_make(IntermediateCache& cache, const ContentHash& hash, const ContentHash& shape,
                                      const Make& make) {
    if (const auto found = cache.find(hash)) return std::static_pointer_cast<const T>(found);
    cache.make_room(shape);
    std::shared_ptr<const T> made = make();
    cache.put(made);
    return made;
}

}  // namespace multires
