#include "stream/decoder.h"
#include "stream/encoder.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

// The decoder for programs that load the plugin as a shared library: the Python package's Stream does, through ctypes.
// A handle is used by one thread at a time. What fails returns 0 and leaves a message.

#ifdef _WIN32
#define MULTIRES_EXPORT extern "C" __declspec(dllexport)
#else
#define MULTIRES_EXPORT extern "C" __attribute__((visibility("default")))
#endif

namespace {

struct Handle {
    multires::stream::Decoder decoder;
    multires::Layer layer;
    std::string message;
    multires::stream::Bytes bytes;
};

template <class Do>
int guarded(Handle* handle, const Do& something) {
    try {
        something();
        return 1;
    } catch (const std::exception& e) {
        handle->message = e.what();
        return 0;
    }
}

}  // namespace

/// @param vertices  where to stop, 0: nowhere
/// @param error     likewise, mesh units
MULTIRES_EXPORT void* multires_stream_new(std::int32_t vertices, double error) {
    multires::stream::Limits limits;
    if (vertices > 0) limits.vertices = vertices;
    if (error > 0) limits.error = error;
    try {
        return new Handle{multires::stream::Decoder(limits), {}, {}, {}};
    } catch (const std::exception&) {
        return nullptr;
    }
}

MULTIRES_EXPORT void multires_stream_free(void* handle) { delete static_cast<Handle*>(handle); }

MULTIRES_EXPORT const char* multires_stream_message(void* handle) {
    return static_cast<Handle*>(handle)->message.c_str();
}

MULTIRES_EXPORT int multires_stream_feed(void* handle, const std::uint8_t* bytes, std::size_t size) {
    auto* h = static_cast<Handle*>(handle);
    return guarded(h, [&] { h->decoder.feed(bytes, size); });
}

/// Whether there is a mesh, whether all has been read, whether a limit has been reached; vertices now and at the end;
/// bytes that are missing.
MULTIRES_EXPORT void multires_stream_state(void* handle, std::int64_t* out) {
    const auto& d = static_cast<Handle*>(handle)->decoder;
    out[0] = d.started(), out[1] = d.finished(), out[2] = d.satisfied();
    out[3] = d.vertices(), out[4] = d.started() ? d.header().vertices : 0;
    out[5] = static_cast<std::int64_t>(d.missing());
}

MULTIRES_EXPORT double multires_stream_error(void* handle) { return static_cast<Handle*>(handle)->decoder.error(); }

/// Takes a copy of the present mesh, which the functions below read.
MULTIRES_EXPORT int multires_stream_take(void* handle) {
    auto* h = static_cast<Handle*>(handle);
    return guarded(h, [&] { h->layer = h->decoder.layer(); });
}

/// Numbers of vertices, faces and attributes, and whether there are wedges.
MULTIRES_EXPORT void multires_stream_sizes(void* handle, std::int64_t* out) {
    const multires::Layer& l = static_cast<Handle*>(handle)->layer;
    out[0] = static_cast<std::int64_t>(l.mesh.positions.size()),
    out[1] = static_cast<std::int64_t>(l.mesh.faces.size());
    out[2] = static_cast<std::int64_t>(l.attributes.size()), out[3] = !l.wedges.empty();
}

/// @param positions  #V by 3
/// @param faces      #F by 3
MULTIRES_EXPORT void multires_stream_mesh(void* handle, double* positions, std::int32_t* faces) {
    const multires::Layer& l = static_cast<Handle*>(handle)->layer;
    for (const multires::Vec3& p : l.mesh.positions) positions = std::copy_n(p.data(), 3, positions);
    for (const multires::Face& f : l.mesh.faces) faces = std::copy_n(f.data(), 3, faces);
}

/// Kind (0 colour, 1 quality, 2 texture coordinate, 3 scalar, 4 point) and width of attribute k.
/// @returns  its name
MULTIRES_EXPORT const char* multires_stream_attribute(void* handle, std::int32_t k, std::int32_t* kind_and_width) {
    const multires::Attribute& a = static_cast<Handle*>(handle)->layer.attributes[k];
    kind_and_width[0] = static_cast<std::int32_t>(a.kind), kind_and_width[1] = a.width;
    return a.name.c_str();
}

/// @param values  #V by width
MULTIRES_EXPORT void multires_stream_values(void* handle, std::int32_t k, double* values) {
    const multires::Attribute& a = static_cast<Handle*>(handle)->layer.attributes[k];
    std::copy(a.values.begin(), a.values.end(), values);
}

/// @param uv  3 #F by 2
MULTIRES_EXPORT void multires_stream_wedges(void* handle, double* uv, std::int32_t* texture) {
    for (const multires::Wedge& w : static_cast<Handle*>(handle)->layer.wedges) {
        *uv++ = w.u, *uv++ = w.v;
        *texture++ = w.texture;
    }
}

/// Writes the whole stream anew with a region first.
/// @param box      whether the region is a box, else a sphere
/// @param numbers  its corners, or centre and radius
/// @returns its size, 0: it failed
MULTIRES_EXPORT std::int64_t multires_stream_region_first(void* handle, int box, const double* numbers) {
    auto* h = static_cast<Handle*>(handle);
    const multires::Vec3 a(numbers[0], numbers[1], numbers[2]);
    const auto inside = [&](const multires::Vec3& p) {
        if (!box) return (p - a).norm() <= numbers[3];
        return (p.array() >= a.array()).all() && p[0] <= numbers[3] && p[1] <= numbers[4] && p[2] <= numbers[5];
    };
    guarded(h, [&] { h->bytes.clear(), h->bytes = multires::stream::region_first(h->decoder, inside); });
    return static_cast<std::int64_t>(h->bytes.size());
}

/// @param out  as many as multires_stream_region_first() said
MULTIRES_EXPORT void multires_stream_bytes(void* handle, std::uint8_t* out) {
    const multires::stream::Bytes& b = static_cast<Handle*>(handle)->bytes;
    std::copy(b.begin(), b.end(), out);
}
