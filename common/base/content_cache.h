#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace multires {

/// What was last worked out for one mesh, newest first, to be found again by its content hash: the same calls with
/// other sliders need not do it twice.
///
/// What is kept is never more than twice the largest of them; the oldest go first. Losing one changes no result, only
/// the time the next call takes: a filter that fails may leave the cache with less than it found.
/// @tparam Content  with hash() of all that it depends on, shape() of the mesh (both of one type) and bytes()
template <class Content>
class ContentCache {
public:
    using Hash = std::decay_t<decltype(std::declval<const Content&>().hash())>;

    /// The one with this content hash, which becomes the newest; null if there is none.
    std::shared_ptr<const Content> find(const Hash& hash) noexcept {
        const auto at = std::find_if(kept_.begin(), kept_.end(), [&](const auto& p) { return p->hash() == hash; });
        if (at == kept_.end()) return nullptr;
        std::rotate(kept_.begin(), at, at + 1);
        return kept_.front();
    }

    /// Lets go of what can no longer be used, that of other shapes than this, and makes room: when one more is built
    /// and put, there were no more than two at any time.
    void make_room(const Hash& shape) noexcept {
        kept_.erase(std::remove_if(kept_.begin(), kept_.end(), [&](const auto& p) { return p->shape() != shape; }),
                    kept_.end());
        shrink_to(largest());
    }

    void put(std::shared_ptr<const Content> content) {
        kept_.insert(kept_.begin(), std::move(content));
        shrink_to(2 * largest());
    }

    /// Newest first.
    const std::vector<std::shared_ptr<const Content>>& all() const noexcept { return kept_; }

    std::size_t bytes() const noexcept {
        std::size_t sum = 0;
        for (const auto& p : kept_) sum += p->bytes();
        return sum;
    }

private:
    std::size_t largest() const noexcept {
        std::size_t most = 0;
        for (const auto& p : kept_) most = std::max(most, p->bytes());
        return most;
    }

    /// Keeps the newest in any case.
    void shrink_to(std::size_t bytes) noexcept {
        while (kept_.size() > 1 && this->bytes() > bytes) kept_.pop_back();
    }

    std::vector<std::shared_ptr<const Content>> kept_;
};

}  // namespace multires
