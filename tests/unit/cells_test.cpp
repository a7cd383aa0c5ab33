#include "mesh/cells.h"

#include "fixtures.h"

#include <numeric>

namespace multires {

TEST(Cells, HoldEveryVertexOnceAndTurnWithTheMesh) {
    const Mesh grid = shapes::plane(60, {0, 1, 1});
    for (const Positions& p :
         {shapes::scan(3000).positions, shapes::irregular_sphere(3000).positions, grid.positions}) {
        const auto cells = cells_of(p, 400);
        std::vector<Index> all;
        for (const auto& cell : cells) {
            EXPECT_LE(cell.size(), 400u);
            EXPECT_GE(cell.size(), 199u);
            all.insert(all.end(), cell.begin(), cell.end());
        }
        std::sort(all.begin(), all.end());
        std::vector<Index> expected(p.size());
        std::iota(expected.begin(), expected.end(), 0);
        EXPECT_EQ(all, expected);
        for (const double angle : {0.3, 1.2, 2.5}) {
            const Eigen::Affine3d place = Eigen::Translation3d(30, -5, 7) *
                                          Eigen::AngleAxisd(angle, Vec3(0.3, -0.8, 0.5).normalized()) *
                                          Eigen::Scaling(0.01);
            Positions moved;
            for (const Vec3& v : p) moved.push_back(place * v);
            EXPECT_EQ(cells_of(moved, 400), cells);
        }
    }
    EXPECT_TRUE(cells_of({}, 10).empty());
    EXPECT_EQ(cells_of(Positions(5, Vec3(1, 2, 3)), 2).size(), 3u);  // at one place
}

}  // namespace multires
