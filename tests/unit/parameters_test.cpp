#include "all_tables.h"
#include "attribute_fixtures.h"
#include "given.h"
#include "reported.h"
#include "result_numbers.h"
#include "shapes.h"

#include "pyramid/band.h"

#include <gtest/gtest.h>

#include <limits>

// Parameters as data: what a field may be given, and that what is given counts.

namespace multires {
namespace {

using namespace plugin;

std::string refusal(const Parameter& p, double value) {
    try {
        set(p, value);
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

const Filter& filter_named(const std::string& name) {
    for (const Filter* f : all_filters())
        if (f->python_name == name) return *f;
    throw std::logic_error("no filter " + name);
}

/// A scan whose default for `name` is the whole number 3, which is a fine limit in any unit.
Layer with_default_of_three(const Filter& filter, const std::string& name) {
    Layer layer = fixtures::with_everything(shapes::scan(3000, {}), fixtures::random_value);
    for (int i = 0; i < 100; ++i)
        for (const Declared& d : declared(filter, &layer))
            if (d.name == name && d.value != 3)
                for (Vec3& p : layer.mesh.positions) p *= 3 / d.value;
    return layer;
}

}  // namespace

TEST(Parameter, ANumberOutOfRangeIsRefusedByNameAndAnEndMissedByRoundingIsTheEnd) {
    double field = 0.5;
    Parameters list;
    const Parameter& p = list.add("share", &field, "Share", "...").between(0, 0.1);
    EXPECT_EQ(refusal(p, 0.2), "Parameter \"share\" (Share) is 0.2; it must be between 0 and 0.1.");
    EXPECT_EQ(refusal(p, -1), "Parameter \"share\" (Share) is -1; it must be between 0 and 0.1.");
    EXPECT_NE(refusal(p, std::numeric_limits<double>::quiet_NaN()), "");
    EXPECT_EQ(field, 0.5);
    set(p, static_cast<double>(0.1F));
    EXPECT_EQ(field, 0.1);
}

TEST(Parameter, ARangeMayBeOpenAndANumberWithoutOneIsFinite) {
    double length = 0, any = 0;
    int count = 0;
    Parameters list;
    EXPECT_EQ(refusal(list.add("length", &length, "Length", "...").at_least(0), -2),
              "Parameter \"length\" (Length) is -2; it must be at least 0.");
    EXPECT_EQ(refusal(list.add("any", &any, "Any", "..."), std::numeric_limits<double>::infinity()),
              "Parameter \"any\" (Any) is inf; it must be a finite number.");
    EXPECT_THROW(set(list.add("count", &count, "Count", "...").between(1, 10), 11), InputError);
}

TEST(Parameter, AChoiceTakesThePlaceOfAName) {
    enum class Color { red, green } color = Color::red;
    Parameters list;
    const Parameter& p = list.add("color", Choice(color, {"red", "green"}), "Colour", "...");
    set(p, 1);
    EXPECT_EQ(color, Color::green);
    EXPECT_THROW(set(p, 2), InputError);
    EXPECT_THROW(set(p, -1), InputError);
}

TEST(Parameter, ADirectionOfAnyLengthBecomesAUnitVectorAndOneOfNoneIsRefused) {
    Vec3 up = Vec3::UnitZ();
    Parameters list;
    const Parameter& p = list.add("up", Direction{&up}, "Up", "...");
    for (const double length : {1e-200, 0.5, 1e200}) {
        set(p, Vec3(length * Vec3(3, 0, 4)));
        EXPECT_LE((up - Vec3(0.6, 0, 0.8)).norm(), 1e-15) << length;
    }
    EXPECT_THROW(set(p, Vec3(0, 0, 0)), InputError);
    EXPECT_THROW(set(p, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 1)), InputError);
}

TEST(Parameter, APointIsTakenAsItIsAndAnAngleHasARange) {
    Vec3 centre(1, 2, 3);
    double angle = 40;
    Parameters list;
    set(list.add("centre", Point{&centre}, "Centre", "..."), Vec3(0, 0, 0));
    EXPECT_EQ(centre, Vec3(0, 0, 0));
    const Parameter& p = list.add("angle", Angle{&angle}, "Angle", "...").between(0, 180);
    set(p, 90.0);
    EXPECT_EQ(angle, 90);
    EXPECT_NE(refusal(p, 181), "");
}

TEST(Parameter, WhetherItWasGivenIsToldApartFromItsValue) {
    double field = 2;
    bool given = false;
    Parameters list;
    const Parameter& p = list.add("cutoff", &field, "Cutoff", "...").derived(given);
    EXPECT_FALSE(given);
    set(p, 2.0);
    EXPECT_TRUE(given);
}

// A limit that is given counts in the unit chosen, also where its number happens to be the default in another one. With
// limits that are whole levels, each gain is 0 or 1.
TEST(Limits, AGivenNumberThatEqualsTheDefaultInAnotherUnitIsTakenAsItIs) {
    struct Case {
        const char *filter, *limit;
        Given given;
        std::size_t first, last;  ///< levels that are removed
    };
    constexpr double level = 2, stop_band = 1;  // of the choices `unit` and `mode`
    for (const Case& c : {
             Case{"apply_coord_multires_low_pass", "cutoff", {}, 0, 3},
             Case{"apply_attributes_multires_band", "cutoff", {}, 0, 3},
             Case{"apply_coord_multires_stop_band", "finest", {{"coarsest", 4}}, 3, 4},
             Case{"apply_coord_multires_stop_band", "coarsest", {{"finest", 1}}, 1, 3},
             Case{"apply_attributes_multires_band", "coarsest", {{"finest", 1}, {"mode", stop_band}}, 1, 3},
             Case{"compute_scalar_multires_detail_per_vertex", "coarsest", {{"finest", 1}}, 1, 3},
         }) {
        SCOPED_TRACE(std::string(c.filter) + ", " + c.limit);
        const Filter& filter = filter_named(c.filter);
        const Layer layer = with_default_of_three(filter, c.limit);
        Given given = c.given;
        given["unit"] = level;
        given[c.limit] = 3;
        Session session;
        const std::vector<double> gains =
            fixtures::reported<std::vector<double>>(run(filter, layer, session, given), "gains");
        ASSERT_GT(gains.size(), c.last);
        for (std::size_t k = 0; k < gains.size(); ++k)
            EXPECT_NEAR(gains[k], k >= c.first && k < c.last ? 0 : 1, 1e-12) << "level " << k;
    }
}

TEST(Limits, WhereOnlyTheUnitIsGivenTheDefaultsAreDerivedInThatUnit) {
    const Filter& filter = filter_named("apply_coord_multires_stop_band");
    const Layer layer = fixtures::with_everything(shapes::scan(3000, {}), fixtures::random_value);
    for (const Unit unit : {Unit::wavelength, Unit::wavelength_percent, Unit::level, Unit::vertices}) {
        const Band band = default_band(layer, unit);
        const double number = static_cast<double>(unit);
        const auto numbers = [&](const Given& given) {
            Session session;
            return fixtures::numbers(run(filter, layer, session, given));
        };
        EXPECT_EQ(numbers({{"unit", number}}),
                  numbers({{"unit", number}, {"finest", band.finest}, {"coarsest", band.coarsest}}));
    }
}

}  // namespace multires
