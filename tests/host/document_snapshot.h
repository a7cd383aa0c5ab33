#pragma once

#include "host/api.h"

#include <string>
#include <vector>

namespace multires::host_tests {

/// All of a document that a filter could change, in bytes.
struct Snapshot {
    std::string document;              ///< layers, the current one, elements with all components, attributes
    std::vector<const void*> storage;  ///< where elements, attributes and originals are
    std::vector<const void*> cached;   ///< pyramids and solvers that are kept; a call that fails may lose them
    std::vector<bool> caches;          ///< layers that keep any
    std::vector<int> ids;              ///< of the layers

    /// The same document, not moved in memory.
    friend bool operator==(const Snapshot& a, const Snapshot& b) {
        return a.document == b.document && a.storage == b.storage && a.ids == b.ids;
    }
    friend bool operator!=(const Snapshot& a, const Snapshot& b) { return !(a == b); }
    /// Equal documents, which may be two; hosts number layers, and a layer that was taken back had a number.
    bool equals(const Snapshot& b) const { return document == b.document && caches == b.caches; }
};

Snapshot snapshot(const MeshDocument& document);

}  // namespace multires::host_tests
