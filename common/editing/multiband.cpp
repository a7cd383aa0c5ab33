#include "editing/multiband.h"

#include "base/parallel.h"
#include "base/reduce.h"

#include <utility>

namespace multires {

Multiband::Multiband(const Mesh& mesh, std::vector<Positions> bases, const Progress& progress) {
    const Array<Index> starts = faces_to_start_from(mesh.faces, mesh.positions.size());
    const auto count = static_cast<double>(bases.size());
    for (std::size_t k = 0; k < bases.size(); ++k) {
        const PhongSurface base(mesh.faces, bases[k]);
        const Positions& finer = k == 0 ? mesh.positions : bases[k - 1];
        const auto at = static_cast<double>(k);
        BasePoints found = base_points(base, finer, starts, progress.part(at / count, (at + 1) / count));
        for (std::size_t i = 0; i < finer.size(); ++i)
            if (starts[i] < 0) found.points[i] = {-1, Vec3::Zero(), finer[i] - bases[k][i], BaseKind::inside};
        border_ += found.border, nearest_ += found.nearest;
        details_.push_back(std::move(found.points));
    }
    coarsest_ = std::move(bases.back());
}

Positions Multiband::reconstruct(const Faces& faces, Positions coarsest, const std::vector<double>& gain) const {
    Positions finer(coarsest.size());
    for (std::size_t k = bands(); k-- > 0;) {
        const PhongSurface base(faces, coarsest);
        parallel_for(static_cast<Index>(finer.size()), [&](Index i) {
            BasePoint b = details_[k][i];
            if (b.face < 0) {
                finer[i] = coarsest[i] + b.detail;
                return;
            }
            b.detail *= gain[k];
            finer[i] = base.place(b);
        });
        std::swap(finer, coarsest);
    }
    return coarsest;
}

std::size_t Multiband::bytes() const {
    std::size_t sum = coarsest_.capacity() * sizeof(Vec3);
    for (const Array<BasePoint>& band : details_) sum += band.capacity() * sizeof(BasePoint);
    return sum;
}

double Multiband::rms_detail(std::size_t band) const {
    const Array<BasePoint>& all = details_[band];
    return chunked_fold<Lengths>(all.size(),
                                 [&](Lengths& part, std::size_t i) { part.add(all[i].detail.squaredNorm()); })
        .rms();
}

}  // namespace multires
