#include "filters/result_hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace multires {
namespace {

class Hash {
public:
    Hash() { XXH3_64bits_reset(&state_); }

    template <class T, class Allocator>
    void add(const std::vector<T, Allocator>& values) {
        static_assert(std::has_unique_object_representations_v<T> || std::is_same_v<T, double>, "padding has no value");
        add(values.data(), values.size() * sizeof(T));
    }
    void add(const Positions& positions) { add(positions.data(), positions.size() * sizeof(Vec3)); }
    void add(const Wedge& w) {
        const double values[] = {w.u, w.v, static_cast<double>(w.texture)};
        add(values, sizeof values);
    }
    double value() const { return static_cast<double>(XXH3_64bits_digest(&state_) >> 12); }
    bool empty() const { return empty_; }

private:
    void add(const void* data, std::size_t bytes) {
        if (bytes == 0) return;
        empty_ = false;
        XXH3_64bits_update(&state_, data, bytes);
    }

    XXH3_state_t state_;
    bool empty_ = true;
};

}  // namespace

double result_hash(const Result& result) {
    Hash hash;
    if (result.positions) hash.add(*result.positions);
    if (result.quality) hash.add(*result.quality);
    for (const Attribute& a : result.attributes) hash.add(a.values);
    if (result.wedges)
        for (const Wedge& w : *result.wedges) hash.add(w);
    if (result.layer) {
        hash.add(result.layer->source_vertex);
        hash.add(result.layer->faces);
        hash.add(result.layer->source_face);
        if (result.layer->positions) hash.add(*result.layer->positions);
    }
    return hash.empty() ? 0 : hash.value();
}

}  // namespace multires
