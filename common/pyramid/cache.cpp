#include "pyramid/cache.h"

#include <algorithm>

namespace multires {

std::shared_ptr<const Pyramid> PyramidCache::find(const ContentHash& hash) noexcept {
    const auto at = std::find_if(kept_.begin(), kept_.end(), [&](const auto& p) { return p->hash() == hash; });
    if (at == kept_.end()) return nullptr;
    std::rotate(kept_.begin(), at, at + 1);
    return kept_.front();
}

void PyramidCache::make_room(const ContentHash& shape) noexcept {
    kept_.erase(std::remove_if(kept_.begin(), kept_.end(), [&](const auto& p) { return p->shape() != shape; }),
                kept_.end());
    shrink_to(largest());
}

void PyramidCache::put(std::shared_ptr<const Pyramid> pyramid) {
    kept_.insert(kept_.begin(), std::move(pyramid));
    shrink_to(2 * largest());
}

std::size_t PyramidCache::bytes() const noexcept {
    std::size_t sum = 0;
    for (const auto& p : kept_) sum += p->bytes();
    return sum;
}

std::size_t PyramidCache::largest() const noexcept {
    std::size_t most = 0;
    for (const auto& p : kept_) most = std::max(most, p->bytes());
    return most;
}

/// Keeps the newest in any case.
void PyramidCache::shrink_to(std::size_t bytes) noexcept {
    while (kept_.size() > 1 && this->bytes() > bytes) kept_.pop_back();
}

}  // namespace multires
