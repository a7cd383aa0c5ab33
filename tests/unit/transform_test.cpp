#include "schemes/burt_adelson.h"

#include "measure/measure.h"

#include "hierarchy_checks.h"

namespace multires {

using namespace fixtures;

namespace {

constexpr Operator operators[] = {Operator::umbrella,          Operator::cotangent,
                                  Operator::cotangent_clamped, Operator::cotangent_delaunay,
                                  Operator::second_difference, Operator::second_difference_flaps};

RelaxationTransformOptions options_of(Scheme scheme, Operator op, double presmooth) {
    RelaxationTransformOptions options;
    options.scheme = scheme;
    options.relaxation.op = op;
    options.presmooth = presmooth;
    return options;
}

/// The hierarchies of every class and grouping, made once.
const Hierarchy& hierarchy(std::size_t mesh, std::size_t grouping) {
    static std::map<std::pair<std::size_t, std::size_t>, Hierarchy> made;
    const auto at = made.find({mesh, grouping});
    if (at != made.end()) return at->second;
    return made[{mesh, grouping}] = hierarchy_of(every_class()[mesh].second, groupings()[grouping].second);
}

/// Random numbers in [-1, 1].
Field random_channels(Index rows, int width, std::uint64_t seed) {
    shapes::Random random(seed);
    Field f(rows, width);
    for (double& v : f.values) v = random.uniform(-1, 1);
    return f;
}

/// Channels and `more` random ones beside them.
Field with_random_channels(const Field& given, int more, std::uint64_t seed) {
    Field f = random_channels(given.rows(), given.width + more, seed);
    for (Index r = 0; r < f.rows(); ++r) std::copy_n(given.row(r), given.width, f.row(r));
    return f;
}

double largest_difference(const Field& a, const Field& b) {
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.values.size(), b.values.size());
    double largest = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i) largest = std::max(largest, std::abs(a.values[i] - b.values[i]));
    return largest;
}

double largest(const Field& f) {
    double most = 0;
    for (const double v : f.values) most = std::max(most, std::abs(v));
    return most;
}

class TransformWith : public testing::TestWithParam<Operator> {};

}  // namespace

TEST_P(TransformWith, IsInvertedExactly) {
    int cases = 0;
    for (std::size_t m = 0; m < every_class().size(); ++m)
        for (std::size_t g = 0; g < groupings().size(); ++g)
            for (const Scheme scheme : {Scheme::roy, Scheme::guskov})
                for (const double presmooth : {0.0, 0.5, 1.0}) {
                    SCOPED_TRACE(every_class()[m].first + ", " + groupings()[g].first + ", scheme " +
                                 std::to_string(static_cast<int>(scheme)) + ", presmooth " + std::to_string(presmooth));
                    const Hierarchy& h = hierarchy(m, g);
                    const auto transform = relaxation_transform(h, options_of(scheme, GetParam(), presmooth));
                    const int more = ++cases % 50 == 0 ? 17 : cases % 7;
                    const Field f = with_random_channels(field_of(h.positions), more, cases);
                    const Field back = transform->synthesise(transform->analyse(f));
                    EXPECT_LE(largest_difference(back, f), 1e-12 * bounding_box(h.positions).diagonal());
                }
}

TEST_P(TransformWith, InvertsFieldsWithoutPositions) {
    for (std::size_t m = 0; m < every_class().size(); ++m)
        for (const Scheme scheme : {Scheme::roy, Scheme::guskov}) {
            SCOPED_TRACE(every_class()[m].first);
            const Hierarchy& h = hierarchy(m, m % 4);
            const auto transform = relaxation_transform(h, options_of(scheme, GetParam(), 0.5));
            for (int width = 1; width <= 6; ++width) {
                Field f = random_channels(h.vertices(), width, width);
                f.has_positions = false;
                EXPECT_LE(largest_difference(transform->synthesise(transform->analyse(f)), f), 1e-12);
            }
        }
}

// Half the memory: float weights predict as well as any, float details invert to 6e-8 of their length, and nothing
// that the bands do changes by more.
TEST_P(TransformWith, SingleStorageInvertsAndFiltersAlike) {
    for (std::size_t m = 0; m < every_class().size(); ++m)
        for (const Scheme scheme : {Scheme::roy, Scheme::guskov}) {
            SCOPED_TRACE(every_class()[m].first);
            const Hierarchy& h = hierarchy(m, m % 4);
            RelaxationTransformOptions options = options_of(scheme, GetParam(), 0.5);
            const auto wide = relaxation_transform(h, options);
            options.weights = Storage::single;
            const auto single = relaxation_transform(h, options);
            const Field f = field_of(h.positions);
            const double diagonal = bounding_box(h.positions).diagonal();
            EXPECT_LE(largest_difference(single->synthesise(single->analyse(f)), f), 1e-12 * diagonal);
            const Coefficients stored = single->analyse(f, Storage::single);
            for (const auto& d : stored.detail) {
                EXPECT_TRUE(d.odd.values.empty() && d.even.values.empty());
                EXPECT_EQ(widened(d, 3).odd.rows() + widened(d, 3).even.rows(),
                          static_cast<Index>(d.odd_single.size() + d.even_single.size()) / 3);
            }
            EXPECT_LE(largest_difference(single->synthesise(stored), f), 1e-6 * diagonal);
            Field constant(h.vertices(), 1);
            std::fill(constant.values.begin(), constant.values.end(), 3.0);
            for (const auto& d : single->analyse(constant).detail)
                EXPECT_EQ(std::max(largest(d.odd), largest(d.even)), 0) << "differences to one value sum to nothing";
            if (scheme == Scheme::guskov) continue;  // a frame may fall on the other side of a limit
            const std::vector<double> gain(h.levels.size(), 0.3);
            EXPECT_LE(largest_difference(single->synthesise(stored, gain), wide->synthesise(wide->analyse(f), gain)),
                      2e-5 * diagonal);
        }
}

TEST_P(TransformWith, ReproducesConstants) {
    for (std::size_t m = 0; m < every_class().size(); ++m)
        for (const Scheme scheme : {Scheme::roy, Scheme::guskov}) {
            SCOPED_TRACE(every_class()[m].first);
            const Hierarchy& h = hierarchy(m, m % 4);
            const auto transform = relaxation_transform(h, options_of(scheme, GetParam(), 0.5));
            Field f(h.vertices(), 1);
            std::fill(f.values.begin(), f.values.end(), 3.0);
            Coefficients c = transform->analyse(f);
            // Rows sum to 1 up to the rounding of their largest weights, which are below 1e3 here.
            for (const auto& d : c.detail) EXPECT_LE(std::max(largest(d.odd), largest(d.even)), 1e-11);
            const Field low = transform->synthesise(c, std::vector<double>(h.levels.size(), 0));
            EXPECT_LE(largest_difference(low, f), 1e-11);
        }
}

TEST_P(TransformWith, RoysSchemeIsLinear) {
    for (std::size_t m = 0; m < every_class().size(); ++m) {
        SCOPED_TRACE(every_class()[m].first);
        const Hierarchy& h = hierarchy(m, m % 4);
        const auto transform = relaxation_transform(h, options_of(Scheme::roy, GetParam(), 0.5));
        const Field f = random_channels(h.vertices(), 2, 1);
        const Field g = random_channels(h.vertices(), 2, 2);
        Field sum = f;
        for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] = 2.5 * f.values[i] - g.values[i];
        const Coefficients cf = transform->analyse(f), cg = transform->analyse(g), cs = transform->analyse(sum);
        std::vector<double> gain;
        shapes::Random random(m);
        for (std::size_t k = 0; k < h.levels.size(); ++k) gain.push_back(random.uniform(0, 2));
        const Field sf = transform->synthesise(cf, gain), sg = transform->synthesise(cg, gain);
        const Field ss = transform->synthesise(cs, gain);
        const double size = 1 + std::max({largest(sf), largest(sg), largest(cf.base), largest(cg.base)});
        for (std::size_t i = 0; i < ss.values.size(); ++i)
            ASSERT_NEAR(ss.values[i], 2.5 * sf.values[i] - sg.values[i], 1e-11 * size);
    }
}

TEST_P(TransformWith, CopiesOfAPositionChannelFollowIt) {
    for (std::size_t m = 0; m < every_class().size(); ++m) {
        SCOPED_TRACE(every_class()[m].first);
        const Hierarchy& h = hierarchy(m, m % 4);
        const auto transform = relaxation_transform(h, options_of(Scheme::roy, GetParam(), 0.5));
        Field f(h.vertices(), 5);
        for (Index p = 0; p < h.vertices(); ++p) {
            const Vec3& x = h.positions[p];
            std::copy_n(std::begin({x.x(), x.y(), x.z(), x.z(), x.x()}), 5, f.row(p));
        }
        std::vector<double> gain(h.levels.size());
        for (std::size_t k = 0; k < gain.size(); ++k) gain[k] = k % 3;
        const Field out = transform->synthesise(transform->analyse(f), gain);
        for (Index p = 0; p < out.rows(); ++p) {
            EXPECT_EQ(out.row(p)[3], out.row(p)[2]);
            EXPECT_EQ(out.row(p)[4], out.row(p)[0]);
        }
    }
}

TEST_P(TransformWith, DoesNotDependOnThreads) {
    static const Hierarchy h = hierarchy_of(shapes::scan(6000));
    for (const Scheme scheme : {Scheme::roy, Scheme::guskov}) {
        const Field f = with_random_channels(field_of(h.positions), 2, 5);
        const auto run = [&](int count) {
            const Threads threads(count);
            const auto transform = relaxation_transform(h, options_of(scheme, GetParam(), 0.5));
            return transform->synthesise(transform->analyse(f), std::vector<double>(h.levels.size(), 0.3));
        };
        EXPECT_EQ(run(1).values, run(2).values);
    }
}

INSTANTIATE_TEST_SUITE_P(Transform, TransformWith, testing::ValuesIn(operators));

TEST(Transform, LinearFunctionsOnPlanesHaveNoDetailInside) {
    for (const Operator op : operators) {
        if (op == Operator::umbrella || op == Operator::cotangent_clamped) continue;  // not linear precise
        for (const Mesh& mesh : {shapes::plane(20), shapes::disk(10)}) {
            HierarchyOptions options;
            options.base_vertices = 30;
            const Hierarchy h = hierarchy_of(mesh, options);
            const auto transform = relaxation_transform(h, options_of(Scheme::roy, op, 0));
            Field f(h.vertices(), 1);
            for (Index p = 0; p < h.vertices(); ++p) *f.row(p) = 2 * h.positions[p].x() - 3 * h.positions[p].y() + 1;
            const Coefficients c = transform->analyse(f);
            Index inside = 0;
            for (std::size_t k = 0; k < h.levels.size(); ++k)
                for (const bool odd : {true, false}) {
                    const Rings& rings = odd ? h.levels[k].odd : h.levels[k].even;
                    const Field& detail = odd ? c.detail[k].odd : c.detail[k].even;
                    for (Index r = 0; r < rings.rows(); ++r) {
                        if (rings.kind[r] != RingKind::closed) continue;
                        EXPECT_NEAR(*detail.row(r), 0, 1e-11) << "level " << k;
                        ++inside;
                    }
                }
            EXPECT_GT(inside, 500);
        }
    }
}

TEST(Transform, GainsMultiplyDetails) {
    const Hierarchy h = hierarchy_of(shapes::scan(1500));
    for (const Scheme scheme : {Scheme::roy, Scheme::guskov}) {
        const auto transform = relaxation_transform(h, options_of(scheme, Operator::second_difference_flaps, 0.5));
        Coefficients c = transform->analyse(field_of(h.positions));
        const Field all = transform->synthesise(c);
        EXPECT_EQ(transform->synthesise(c, std::vector<double>(h.levels.size(), 1)).values, all.values);
        std::vector<double> gain(h.levels.size(), 1);
        gain[0] = 0.25;
        gain[3] = 3;
        const Field expected = transform->synthesise(c, gain);
        EXPECT_GT(largest_difference(expected, all), 1e-3);
        for (std::size_t k = 0; k < gain.size(); ++k)
            for (Field* d : {&c.detail[k].odd, &c.detail[k].even})
                for (double& v : d->values) v *= gain[k];
        EXPECT_LE(largest_difference(transform->synthesise(c), expected), 1e-12);
    }
}

TEST(Transform, StopsAtALevel) {
    const Hierarchy h = hierarchy_of(shapes::scan(1500));
    const Field f = field_of(h.positions);
    for (const Scheme scheme : {Scheme::roy, Scheme::guskov}) {
        const auto transform = relaxation_transform(h, options_of(scheme, Operator::second_difference_flaps, 0));
        const Coefficients c = transform->analyse(f);
        EXPECT_EQ(transform->synthesise(c, {}, h.levels.size()).values, c.base.values);
        // Without presmoothing coarse levels are subsets of the values.
        for (std::size_t k = 0; k <= h.levels.size(); ++k) {
            const Field level = transform->synthesise(c, {}, k);
            ASSERT_EQ(level.rows(), h.size[k]);
            for (std::size_t i = 0; i < level.values.size(); ++i) ASSERT_NEAR(level.values[i], f.values[i], 1e-12);
        }
    }
}

TEST(Transform, GuskovsDetailsTurnWithTheSurface) {
    const Mesh mesh = shapes::scan(1500);
    Motion motion;
    motion.offset.setZero();
    const Hierarchy h = hierarchy_of(mesh), turned = hierarchy_of(motion(mesh));
    ASSERT_EQ(h.order, turned.order);
    for (const Operator op : {Operator::cotangent_delaunay, Operator::second_difference_flaps}) {
        const auto transform = relaxation_transform(h, options_of(Scheme::guskov, op, 0.5));
        const auto of_turned = relaxation_transform(turned, options_of(Scheme::guskov, op, 0.5));
        Coefficients c = transform->analyse(field_of(h.positions));
        const Coefficients d = of_turned->analyse(field_of(turned.positions));
        for (std::size_t k = 0; k < h.levels.size(); ++k) {
            EXPECT_GT(largest(c.detail[k].odd), 1e-4);
            EXPECT_LE(largest_difference(c.detail[k].odd, d.detail[k].odd), 1e-10) << "level " << k;
            EXPECT_LE(largest_difference(c.detail[k].even, d.detail[k].even), 1e-10) << "level " << k;
        }
        // So a base that is turned by hand takes all details with it.
        Positions base = positions_of(c.base);
        for (Vec3& p : base) p = motion(p);
        c.base = field_of(base);
        EXPECT_LE(largest_difference(transform->synthesise(c), field_of(turned.positions)), 1e-10);
    }
}

TEST(Transform, PlacesAndInputOrderAreInverse) {
    const Mesh mesh = shapes::scan(700);
    const Hierarchy h = hierarchy_of(mesh);
    const Field f = with_random_channels(field_of(mesh.positions), 2, 9);
    const Field places = to_places(h, f);
    EXPECT_EQ(to_input(h, places).values, f.values);
    for (Index p = 0; p < h.vertices(); ++p) EXPECT_EQ(places.row(p)[0], h.positions[p].x());
    EXPECT_EQ(positions_of(field_of(mesh.positions)), mesh.positions);
}

}  // namespace multires
