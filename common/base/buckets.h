#pragma once

#include "base/array.h"
#include "base/index.h"
#include "base/parallel.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace multires {

/// Items sorted into buckets by counting, stable: the faces of each vertex, say. Bucket b is buckets[b].
/// Cost: linear; two visits of every item.
template <class Item = Index>
class Buckets {
public:
    /// The items of one bucket.
    template <class T>
    struct Range {
        T *first, *last;
        T* begin() const { return first; }
        T* end() const { return last; }
        Index size() const { return static_cast<Index>(last - first); }
        T& operator[](Index i) const { return first[i]; }
    };

    Buckets() = default;

    /// @param visit  calls put(bucket, item) for every item, in order; called twice
    template <class Visit>
    Buckets(Index buckets, const Visit& visit) : offset_(buckets + 2, 0) {
        visit([&](Index b, const Item&) { ++offset_[b + 2]; });
        std::partial_sum(offset_.begin(), offset_.end(), offset_.begin());
        item_.resize(offset_.back());
        // offset_[b + 1] is where the next item of bucket b goes and, in the end, where the bucket ends.
        visit([&](Index b, const Item& item) { item_[offset_[b + 1]++] = item; });
        offset_.pop_back();
    }

    /// The first in parallel, with an Index for each part and bucket meanwhile.
    /// @param visit  calls put(bucket, item) for every item of a part, in order, parts in theirs; called twice for each
    template <class Visit>
    static Buckets in_parts(Index buckets, Index parts, const Visit& visit) {
        Buckets out;
        Array<Index> next(static_cast<std::size_t>(parts) * buckets);  // the size, then the place of a part's next item
        const auto of = [&](Index part) { return next.data() + static_cast<std::size_t>(part) * buckets; };
        const auto count = [&](Index part) {
            Index* const size = of(part);
            std::fill_n(size, buckets, 0);
            visit(part, [&](Index b, const Item&) { ++size[b]; });
        };
        const auto place = [&](Index part) {
            Index* const at = of(part);
            visit(part, [&](Index b, const Item& item) { out.item_[at[b]++] = item; });
        };
        parallel_for(parts, count, 1);
        out.offset_.resize(buckets + 1);
        Index sum = 0;
        for (Index b = 0; b < buckets; ++b) {
            out.offset_[b] = sum;
            for (Index part = 0; part < parts; ++part) sum += std::exchange(of(part)[b], sum);
        }
        out.offset_[buckets] = sum;
        out.item_.resize(sum);
        parallel_for(parts, place, 1);
        return out;
    }

    /// The numbers 0 .. items-1 by bucket_of(number).
    template <class BucketOf>
    Buckets(Index buckets, Index items, const BucketOf& bucket_of)
        : Buckets(buckets, [&](const auto& put) {
              for (Index i = 0; i < items; ++i) put(bucket_of(i), i);
          }) {}

    Index size() const { return static_cast<Index>(offset_.size()) - 1; }
    Index items() const { return static_cast<Index>(item_.size()); }
    Range<Item> operator[](Index b) { return {item_.data() + offset_[b], item_.data() + offset_[b + 1]}; }
    Range<const Item> operator[](Index b) const { return {item_.data() + offset_[b], item_.data() + offset_[b + 1]}; }

private:
    Array<Index> offset_{0};  ///< #buckets + 1
    Array<Item> item_;
};

}  // namespace multires
