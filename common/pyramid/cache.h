#pragma once

#include "pyramid/pyramid.h"

#include <memory>
#include <vector>

namespace multires {

/// The pyramids of one mesh that were used last, newest first: one for each set of options. Filters with other defaults
/// thus find theirs again when they are used in turn.
///
/// What is kept is never more than twice the largest of them; the oldest go first. Losing one changes no result, only
/// the time the next call takes: a filter that fails may leave the cache with less than it found.
class PyramidCache {
public:
    /// The pyramid with this content hash, which becomes the newest; null if there is none.
    std::shared_ptr<const Pyramid> find(const ContentHash& hash) noexcept;

    /// Lets go of what can no longer be used, pyramids of other shapes than this, and makes room: when one more is
    /// built and put, there were no more than two at any time.
    void make_room(const ContentHash& shape) noexcept;

    void put(std::shared_ptr<const Pyramid> pyramid);

    /// Newest first.
    const std::vector<std::shared_ptr<const Pyramid>>& all() const noexcept { return kept_; }
    std::size_t bytes() const noexcept;

private:
    std::size_t largest() const noexcept;
    void shrink_to(std::size_t bytes) noexcept;

    std::vector<std::shared_ptr<const Pyramid>> kept_;
};

}  // namespace multires
