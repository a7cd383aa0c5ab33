#include "schemes/table.h"

#include "measure/measure.h"

#include "operator_fixtures.h"
#include "scheme_fixtures.h"

#include <array>
#include <map>

namespace multires {

using namespace fixtures;

namespace {

SchemeOptions options_of(int scheme, Operator op, double presmooth) {
    SchemeOptions options;
    options.row = scheme;
    options.op = op;
    options.presmooth = presmooth;
    return options;
}

/// The hierarchies of every class and grouping, made once.
const Hierarchy& hierarchy(int scheme, std::size_t mesh, std::size_t grouping) {
    static std::map<std::array<std::size_t, 3>, Hierarchy> made;
    const std::size_t kind = takes_any_mesh(scheme) ? 0 : static_cast<std::size_t>(scheme);
    const auto at = made.find({kind, mesh, grouping});
    if (at != made.end()) return at->second;
    return made[{kind, mesh, grouping}] =
               hierarchy_for(scheme, every_class()[mesh].second, groupings()[grouping].second);
}

/// Those that take a class of meshes; those of one kind of meshes, which have no operator, only with the first.
std::vector<int> schemes_of(std::size_t mesh, Operator op) {
    std::vector<int> all = every_scheme();
    for (const int scheme : all_schemes()) {
        if (takes_any_mesh(scheme) || op != Operator::umbrella) continue;
        try {
            hierarchy(scheme, mesh, 0);
            all.push_back(scheme);
        } catch (const InputError&) {
        }
    }
    return all;
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

double largest_detail(const Coefficients& c) {
    double most = 0;
    for (const std::vector<Subband>& level : c.level)
        for (const Subband& band : level) most = std::max(most, largest(band.values));
    return most;
}

class SchemeWith : public testing::TestWithParam<Operator> {};

}  // namespace

#ifdef MULTIRES_SANITIZED
constexpr int every = 7;  // which has no factor in common with the numbers of choices
#else
constexpr int every = 1;
#endif

TEST_P(SchemeWith, IsInvertedExactly) {
    int cases = 0;
    for (std::size_t m = 0; m < every_class().size(); ++m)
        for (std::size_t g = 0; g < groupings().size(); ++g)
            for (const int scheme : schemes_of(m, GetParam()))
                for (const double presmooth : {0.0, 0.5, 1.0}) {
                    if (++cases % every != 0) continue;
                    SCOPED_TRACE(every_class()[m].first + ", " + groupings()[g].first + ", " + scheme_name(scheme) +
                                 ", presmooth " + std::to_string(presmooth));
                    const Hierarchy& h = hierarchy(scheme, m, g);
                    const auto made = make_scheme(h, options_of(scheme, GetParam(), presmooth));
                    const int more = cases % 50 == 0 ? 17 : cases % 6;
                    const Field f = with_random_channels(field_of(h.positions), more, cases);
                    const Field back = made->synthesise(made->analyse(f));
                    EXPECT_LE(largest_difference(back, f), 1e-12 * bounding_box(h.positions).diagonal());
                }
}

TEST_P(SchemeWith, InvertsFieldsWithoutPositions) {
    for (std::size_t m = 0; m < every_class().size(); ++m)
        for (const int scheme : schemes_of(m, GetParam())) {
            SCOPED_TRACE(every_class()[m].first);
            const Hierarchy& h = hierarchy(scheme, m, m % 4);
            const auto made = make_scheme(h, options_of(scheme, GetParam(), 0.5));
            for (int width = 1; width <= 6; ++width) {
                Field f = random_channels(h.vertices(), width, width);
                f.has_positions = false;
                EXPECT_LE(largest_difference(made->synthesise(made->analyse(f)), f), 1e-12);
            }
        }
}

// Half the memory: float weights predict as well as any, float details invert to 6e-8 of their length, and nothing
// that the bands do changes by more.
TEST_P(SchemeWith, SingleStorageInvertsAndFiltersAlike) {
    for (std::size_t m = 0; m < every_class().size(); ++m)
        for (const int scheme : schemes_of(m, GetParam())) {
            SCOPED_TRACE(every_class()[m].first);
            const Hierarchy& h = hierarchy(scheme, m, m % 4);
            SchemeOptions options = options_of(scheme, GetParam(), 0.5);
            const auto wide = make_scheme(h, options);
            options.storage = Storage::single;
            const auto single = make_scheme(h, options);
            const Field f = field_of(h.positions);
            const double diagonal = bounding_box(h.positions).diagonal();
            EXPECT_LE(largest_difference(single->synthesise(single->analyse(f)), f), 1e-12 * diagonal);
            const Coefficients stored = single->analyse(f, Storage::single);
            for (const std::vector<Subband>& level : stored.level)
                for (Subband band : level) {
                    EXPECT_TRUE(band.values.values.empty());
                    EXPECT_EQ(static_cast<Index>(band.single.size()), 3 * band.rows());
                    widen(band);
                    EXPECT_EQ(band.values.rows(), band.rows());
                }
            EXPECT_LE(largest_difference(single->synthesise(stored), f), 1e-6 * diagonal);
            Field constant(h.vertices(), 1);
            std::fill(constant.values.begin(), constant.values.end(), 3.0);
            EXPECT_EQ(largest_detail(single->analyse(constant)), 0) << "differences to one value sum to nothing";
            if (can(scheme).local_frames) continue;  // a frame may fall on the other side of a limit
            const std::vector<double> gain(h.levels.size(), 0.3);
            EXPECT_LE(largest_difference(single->synthesise(stored, with_gain(gain)),
                                         wide->synthesise(wide->analyse(f), with_gain(gain))),
                      2e-5 * diagonal);
        }
}

TEST_P(SchemeWith, HandsOverTheRowsOfItsSynthesis) {
    int cases = 0;
    for (std::size_t m = 0; m < every_class().size(); ++m)
        for (const int scheme : schemes_of(m, GetParam())) {
            SCOPED_TRACE(every_class()[m].first + ", " + scheme_name(scheme));
            const Hierarchy& h = hierarchy(scheme, m, ++cases % 4);
            SchemeOptions options = options_of(scheme, GetParam(), 0.5);
            options.storage = cases % 3 == 0 ? Storage::single : Storage::wide;
            const auto made = make_scheme(h, options);
            const Field f = with_random_channels(field_of(h.positions), cases % 3, m);
            const Coefficients c = made->analyse(f, options.storage);
            Field rows(f.rows(), f.width);
            std::vector<int> times(f.rows(), 0);
            made->hand_over(c, [&](Index place, const double* values) {
                std::copy_n(values, f.width, rows.row(place));
                ++times[place];
            });
            EXPECT_EQ(rows.values, made->synthesise(c).values);
            EXPECT_EQ(std::count(times.begin(), times.end(), 1), f.rows());
        }
}

TEST_P(SchemeWith, ReproducesConstants) {
    for (std::size_t m = 0; m < every_class().size(); ++m)
        for (const int scheme : schemes_of(m, GetParam())) {
            SCOPED_TRACE(every_class()[m].first);
            const Hierarchy& h = hierarchy(scheme, m, m % 4);
            const auto made = make_scheme(h, options_of(scheme, GetParam(), 0.5));
            Field f(h.vertices(), 1);
            std::fill(f.values.begin(), f.values.end(), 3.0);
            Coefficients c = made->analyse(f);
            // Rows sum to 1 up to the rounding of their largest weights, which are below 1e3 here.
            EXPECT_LE(largest_detail(c), 1e-11);
            const Field low = made->synthesise(c, with_gain(std::vector<double>(h.levels.size(), 0)));
            EXPECT_LE(largest_difference(low, f), 1e-11);
        }
}

TEST_P(SchemeWith, IsLinearInFieldsThatNothingTurns) {
    for (std::size_t m = 0; m < every_class().size(); ++m)
        for (const int scheme : schemes_of(m, GetParam())) {
            SCOPED_TRACE(every_class()[m].first + ", " + scheme_name(scheme));
            const Hierarchy& h = hierarchy(scheme, m, m % 4);
            const auto made = make_scheme(h, options_of(scheme, GetParam(), 0.5));
            const auto channels = [&](std::uint64_t seed) {
                Field f = random_channels(h.vertices(), 3, seed);
                f.has_positions = !can(scheme).local_frames;
                return f;
            };
            const Field f = channels(1), g = channels(2);
            Field sum = f;
            for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] = 2.5 * f.values[i] - g.values[i];
            const Coefficients cf = made->analyse(f), cg = made->analyse(g), cs = made->analyse(sum);
            std::vector<double> gain;
            shapes::Random random(m);
            for (std::size_t k = 0; k < h.levels.size(); ++k) gain.push_back(random.uniform(0, 2));
            const Field sf = made->synthesise(cf, with_gain(gain)), sg = made->synthesise(cg, with_gain(gain));
            const Field ss = made->synthesise(cs, with_gain(gain));
            const double size = 1 + std::max({largest(sf), largest(sg), largest(cf.base), largest(cg.base)});
            for (std::size_t i = 0; i < ss.values.size(); ++i)
                ASSERT_NEAR(ss.values[i], 2.5 * sf.values[i] - sg.values[i], 1e-11 * size);
        }
}

TEST_P(SchemeWith, EqualChannelsStayEqual) {
    for (std::size_t m = 0; m < every_class().size(); ++m)
        for (const int scheme : schemes_of(m, GetParam())) {
            SCOPED_TRACE(every_class()[m].first + ", " + scheme_name(scheme));
            const Hierarchy& h = hierarchy(scheme, m, m % 4);
            const auto made = make_scheme(h, options_of(scheme, GetParam(), 0.5));
            Field f(h.vertices(), 5);
            f.has_positions = !can(scheme).local_frames;
            for (Index p = 0; p < h.vertices(); ++p) {
                const Vec3& x = h.positions[p];
                std::copy_n(std::begin({x.x(), x.y(), x.z(), x.z(), x.x()}), 5, f.row(p));
            }
            std::vector<double> gain(h.levels.size());
            for (std::size_t k = 0; k < gain.size(); ++k) gain[k] = k % 3;
            const Field out = made->synthesise(made->analyse(f), with_gain(gain));
            for (Index p = 0; p < out.rows(); ++p) {
                EXPECT_EQ(out.row(p)[3], out.row(p)[2]);
                EXPECT_EQ(out.row(p)[4], out.row(p)[0]);
            }
        }
}

TEST_P(SchemeWith, DoesNotDependOnThreads) {
    static std::map<int, Hierarchy> made;
    for (const int scheme : all_schemes()) {
        Hierarchy& h = made[takes_any_mesh(scheme) ? 0 : scheme];
        if (h.order.empty()) h = hierarchy_for(scheme, suited(scheme, shapes::scan(6000)));
        const Field f = with_random_channels(field_of(h.positions), 2, 5);
        const auto run = [&](int count) {
            const Threads threads(count);
            const auto made = make_scheme(h, options_of(scheme, GetParam(), 0.5));
            return made->synthesise(made->analyse(f), with_gain(std::vector<double>(h.levels.size(), 0.3)));
        };
        EXPECT_EQ(run(1).values, run(2).values);
    }
}

INSTANTIATE_TEST_SUITE_P(Scheme, SchemeWith, testing::ValuesIn(all_operators));

TEST(Scheme, LinearFunctionsOnPlanesHaveNoDetailInside) {
    for (const Operator op : linear_precise) {
        for (const Mesh& plane : {shapes::plane(20), shapes::disk(10)})
            for (const int scheme : all_schemes()) {
                if (!can(scheme).linear_precision) continue;
                Mesh mesh = suited(scheme, plane);
                for (Vec3& p : mesh.positions) p.z() = 0;
                SCOPED_TRACE(scheme_name(scheme) + ", operator " + std::to_string(static_cast<int>(op)));
                HierarchyOptions options;
                options.base_vertices = 30;
                const Hierarchy h = hierarchy_for(scheme, mesh, options);
                const auto made = make_scheme(h, options_of(scheme, op, 0));
                Field f(h.vertices(), 1);
                for (Index p = 0; p < h.vertices(); ++p)
                    *f.row(p) = 2 * h.positions[p].x() - 3 * h.positions[p].y() + 1;
                const Coefficients c = made->analyse(f);
                Index inside = 0;
                for (const std::vector<Subband>& level : c.level)
                    for (const Subband& band : level)
                        for (Index r = 0; r < band.rows(); ++r) {
                            if (band.rings->kind[band.range.begin + r] != RingKind::closed) continue;
                            EXPECT_NEAR(*band.values.row(r), 0, 1e-11);
                            ++inside;
                        }
                EXPECT_GT(inside, 150);
            }
    }
}

TEST(Scheme, GainsMultiplyDetails) {
    for (const int scheme : all_schemes()) {
        SCOPED_TRACE(scheme_name(scheme));
        const Hierarchy h = hierarchy_for(scheme, suited(scheme, shapes::scan(1500)));
        const auto made = make_scheme(h, options_of(scheme, Operator::second_difference_flaps, 0.5));
        Coefficients c = made->analyse(field_of(h.positions));
        const Field all = made->synthesise(c);
        EXPECT_EQ(made->synthesise(c, with_gain(std::vector<double>(h.levels.size(), 1))).values, all.values);
        std::vector<double> gain(h.levels.size(), 1);
        ASSERT_GE(gain.size(), 2u);
        gain[0] = 0.25;
        gain[std::min<std::size_t>(3, gain.size() - 1)] = 3;
        const Field expected = made->synthesise(c, with_gain(gain));
        EXPECT_GT(largest_difference(expected, all), 1e-3);
        for (std::size_t k = 0; k < gain.size(); ++k)
            for (Subband& band : c.level[k])
                for (double& v : band.values.values) v *= gain[k];
        EXPECT_LE(largest_difference(made->synthesise(c), expected), 1e-12);
    }
}

TEST(Scheme, StopsAtALevel) {
    const Hierarchy h = hierarchy_of(shapes::scan(1500));
    const Field f = field_of(h.positions);
    for (const int scheme : every_scheme()) {
        SchemeOptions options = options_of(scheme, Operator::second_difference_flaps, 0);
        options.update = Update::none;
        const auto made = make_scheme(h, options);
        const Coefficients c = made->analyse(f);
        EXPECT_EQ(made->synthesise(c, down_to(h.levels.size())).values, c.base.values);
        // Without presmoothing or update coarse levels are subsets of the values.
        for (std::size_t k = 0; k <= h.levels.size(); ++k) {
            const Field level = made->synthesise(c, down_to(k));
            ASSERT_EQ(level.rows(), h.size[k]);
            for (std::size_t i = 0; i < level.values.size(); ++i) ASSERT_NEAR(level.values[i], f.values[i], 1e-12);
        }
    }
}

TEST(Scheme, StartsFromTheValuesOfAnyLevel) {
    for (std::size_t m = 0; m < every_class().size(); ++m)
        for (const int scheme : every_scheme()) {
            if (!can(scheme).starts_anywhere) continue;
            SCOPED_TRACE(every_class()[m].first + ", " + scheme_name(scheme));
            const Hierarchy& h = hierarchy(scheme, m, m % 4);
            const auto made = make_scheme(h, options_of(scheme, Operator::cotangent_delaunay, 0.5));
            const Field f = with_random_channels(field_of(h.positions), 1, m);
            const Coefficients c = made->analyse(f);
            const std::size_t levels = h.levels.size();
            for (std::size_t k = 0; k <= levels; k += std::max<std::size_t>(1, levels / 4)) {
                const Field values = made->synthesise(c, down_to(k));
                ASSERT_EQ(values.rows(), h.size[k]);
                EXPECT_EQ(made->synthesise(c, starting_at(k, values)).values, made->synthesise(c).values);
                // The part of a way.
                const Synthesis part{k, k / 2, &values, {}};
                EXPECT_EQ(made->synthesise(c, part).values, made->synthesise(c, down_to(k / 2)).values);
                // Details of the levels above do not matter, and no coefficients are details of zero.
                Synthesis none = starting_at(k, values);
                none.gain.assign(levels, 0);
                EXPECT_LE(largest_difference(made->synthesise({}, starting_at(k, values)), made->synthesise(c, none)),
                          1e-12 * (1 + largest(f)));
            }
        }
}

namespace {

/// An open surface: the upper half of a scan.
Mesh half_scan(Index vertices) {
    const Mesh whole = shapes::scan(vertices);
    Mesh half;
    std::vector<Index> number(whole.positions.size(), -1);
    for (const Face& f : whole.faces) {
        if (std::any_of(f.begin(), f.end(), [&](Index v) { return whole.positions[v].z() < 0; })) continue;
        Face g{};
        for (int k = 0; k < 3; ++k) {
            Index& n = number[f[k]];
            if (n < 0) n = static_cast<Index>(half.positions.size()), half.positions.push_back(whole.positions[f[k]]);
            g[k] = n;
        }
        half.faces.push_back(g);
    }
    return half;
}

Motion rotation() {
    Motion motion;
    motion.offset.setZero();
    return motion;
}

}  // namespace

TEST(Scheme, DetailsInLocalFramesTurnWithTheSurface) {
    const Mesh mesh = shapes::scan(1500);
    const Motion motion = rotation();
    const Hierarchy h = hierarchy_of(mesh), turned = hierarchy_of(motion(mesh));
    ASSERT_EQ(h.order, turned.order);
    for (const Operator op : {Operator::cotangent_delaunay, Operator::second_difference_flaps})
        for (const int scheme : every_scheme()) {
            if (!can(scheme).local_frames) continue;
            SCOPED_TRACE(scheme_name(scheme));
            const auto made = make_scheme(h, options_of(scheme, op, 0.5));
            const auto of_turned = make_scheme(turned, options_of(scheme, op, 0.5));
            const Coefficients c = made->analyse(field_of(h.positions));
            const Coefficients d = of_turned->analyse(field_of(turned.positions));
            EXPECT_GT(largest_detail(c), 1e-4);
            Index world = 0;  // rows that do not turn
            for (std::size_t k = 0; k < h.levels.size(); ++k)
                for (std::size_t b = 0; b < c.level[k].size(); ++b) {
                    const Subband &one = c.level[k][b], &other = d.level[k][b];
                    ASSERT_EQ(one.local, other.local);
                    for (Index r = 0; r < one.rows(); ++r) {
                        const Vec3 a(one.values.row(r)), e(other.values.row(r));
                        EXPECT_LE((e - (one.local[r] ? a : motion(a))).norm(), 1e-10) << "level " << k;
                        world += one.local[r] == 0;
                    }
                }
            if (world > 0 || !can(scheme).starts_anywhere) continue;
            // So a level that is moved by hand takes all finer details with it.
            for (std::size_t k = 0; k <= h.levels.size(); ++k) {
                Positions level = positions_of(made->synthesise(c, down_to(k)));
                for (Vec3& p : level) p = Motion()(p);
                Positions expected = h.positions;
                for (Vec3& p : expected) p = Motion()(p);
                EXPECT_LE(largest_difference(made->synthesise(c, starting_at(k, field_of(level))), field_of(expected)),
                          1e-10);
            }
        }
}

TEST(Scheme, NormalsOfRowsTurnWithTheSurface) {
    const Motion motion = rotation();
    for (const int scheme : all_schemes()) {
        SCOPED_TRACE(scheme_name(scheme));
        const Mesh mesh = suited(scheme, half_scan(1500)), moved = motion(mesh);
        const Hierarchy h = hierarchy_for(scheme, mesh), turned = hierarchy_for(scheme, moved);
        ASSERT_EQ(h.order, turned.order);
        const SchemeOptions options = options_of(scheme, Operator::second_difference_flaps, 0.5);
        const auto made = make_scheme(h, options), of_turned = make_scheme(turned, options);
        const Coefficients c = made->analyse(field_of(h.positions));
        const Coefficients d = of_turned->analyse(field_of(turned.positions));
        Index world = 0;
        for (std::size_t k = 0; k < h.levels.size(); ++k)
            for (std::size_t b = 0; b < c.level[k].size(); ++b) {
                const Subband &one = c.level[k][b], &other = d.level[k][b];
                ASSERT_EQ(one.local, other.local);
                for (Index r = 0; r < one.rows(); ++r) {
                    const Vec3 n = made->normal(one, r, mesh.positions),
                               m = of_turned->normal(other, r, moved.positions);
                    EXPECT_NEAR(n.norm(), 1, 1e-12);
                    const bool local = !one.local.empty() && one.local[r];
                    EXPECT_LE((m - (local ? n : motion(n))).norm(), 1e-10);
                    world += !local;
                }
            }
        EXPECT_GT(world, 20) << "boundary vertices have no frames";
    }
}

TEST(Scheme, CriticallySampledOnesHaveAsManyCoefficientsAsValues) {
    std::size_t least = 0, most = 0;
    for (const int scheme : all_schemes()) {
        const Hierarchy h = hierarchy_for(scheme, suited(scheme, shapes::scan(1500)));
        const auto made = make_scheme(h, options_of(scheme, Operator::second_difference_flaps, 0.5));
        const Coefficients c = made->analyse(field_of(h.positions));
        Index rows = c.base.rows();
        for (const std::vector<Subband>& level : c.level)
            for (const Subband& band : level) rows += band.rows();
        EXPECT_EQ(rows == h.vertices(), can(scheme).critically_sampled) << scheme_name(scheme);
        if (!takes_any_mesh(scheme)) continue;  // it has no weights
        std::size_t& bytes = can(scheme).critically_sampled ? most : least;
        bytes = bytes == 0                       ? made->bytes()
                : can(scheme).critically_sampled ? std::max(bytes, made->bytes())
                                                 : std::min(bytes, made->bytes());
    }
    EXPECT_LT(most, least / 2);
}

TEST(Scheme, NeedsOnlyTheRingsItAsksFor) {
    for (const int scheme : every_scheme()) {
        HierarchyOptions options;
        options.even_rings = can(scheme).even_rings;
        for (const Grouping grouping : {Grouping::independent_sets, Grouping::sequential}) {
            options.grouping = grouping;
            const Hierarchy h = hierarchy_of(shapes::scan(800), options), all = hierarchy_of(shapes::scan(800), [&] {
                                                                              HierarchyOptions o = options;
                                                                              o.even_rings = true;
                                                                              return o;
                                                                          }());
            const SchemeOptions how = options_of(scheme, Operator::second_difference_flaps, 0.5);
            const auto made = make_scheme(h, how), with_all = make_scheme(all, how);
            const Coefficients c = made->analyse(field_of(h.positions));
            EXPECT_EQ(c.base.values, with_all->analyse(field_of(all.positions)).base.values);
            EXPECT_LE(largest_difference(made->synthesise(c), field_of(h.positions)), 1e-11);
        }
    }
}

TEST(Scheme, PlacesAndInputOrderAreInverse) {
    const Mesh mesh = shapes::scan(700);
    const Hierarchy h = hierarchy_of(mesh);
    const Field f = with_random_channels(field_of(mesh.positions), 2, 9);
    const Field places = to_places(h, f);
    EXPECT_EQ(to_input(h, places).values, f.values);
    for (Index p = 0; p < h.vertices(); ++p) EXPECT_EQ(places.row(p)[0], h.positions[p].x());
    EXPECT_EQ(positions_of(field_of(mesh.positions)), mesh.positions);
}

}  // namespace multires
