#include "denoise/sample.h"

#include <algorithm>

namespace multires {

Sample patches_of(const Faces& faces, const Positions& positions, const Neighbours& near, Index count, Index size) {
    Sample sample;
    std::vector<Index> place(positions.size(), -1);
    std::vector<Index>& members = sample.vertex;
    for (Index patch = 0; patch < count; ++patch) {
        const Index seed = static_cast<Index>((static_cast<std::int64_t>(near.rows()) * (2 * patch + 1)) / (2 * count));
        if (place[seed] >= 0) continue;
        const std::size_t begin = members.size(), most = begin + static_cast<std::size_t>(size);
        const auto take = [&](Index v) {
            place[v] = static_cast<Index>(members.size());
            members.push_back(v);
        };
        take(seed);
        for (std::size_t next = begin; next < members.size() && members.size() < most; ++next)
            for (Index k = near.offset[members[next]]; k < near.offset[members[next] + 1]; ++k)
                if (place[near.vertex[k]] < 0) take(near.vertex[k]);
        sample.core.resize(members.size(), 0);
        const std::size_t got = members.size() - begin, inner = members.size() >= most ? got * 7 / 10 : got;
        std::fill_n(sample.core.begin() + static_cast<std::ptrdiff_t>(begin), inner, 1);
    }
    sample.positions.resize(members.size());
    for (std::size_t i = 0; i < members.size(); ++i) sample.positions[i] = positions[members[i]];
    const auto inside = [&](const Face& f) { return place[f[0]] >= 0 && place[f[1]] >= 0 && place[f[2]] >= 0; };
    sample.faces.resize(static_cast<std::size_t>(std::count_if(faces.begin(), faces.end(), inside)));
    std::size_t next = 0;
    for (const Face& f : faces)
        if (inside(f)) sample.faces[next++] = {place[f[0]], place[f[1]], place[f[2]]};
    sample.at = vertex_faces(sample.faces, static_cast<Index>(members.size()));
    sample.near = neighbours(sample.faces, sample.at);
    return sample;
}

}  // namespace multires
