#include "all_tables.h"
#include "allocation_faults.h"
#include "suited.h"
#include "variants.h"

#include "../unit/attribute_fixtures.h"
#include "../unit/result_numbers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <new>

// Every filter when memory runs out or the user stops it, at every allocation and at every progress report in turn:
// it must end with an error that says so (or without one, and then with the result it always has), and the next call
// must work. The filters see no document; that it stays the same then is tests/host/document_fault_test.cpp's.

namespace multires {
namespace {

using namespace plugin;
using faults::Shortage;

#ifdef MULTIRES_SANITIZED
constexpr long tried = 100;  // allocations of a call, at most about as many
constexpr long every = 61;   // allocation of a variant, at least
#else
constexpr long tried = 400;
constexpr long every = 11;
#endif
constexpr long tried_of_variant = tried / 4;

/// A closed surface with a boundary, a non-manifold and an unreferenced vertex, and every attribute.
Mesh small_mesh() {
    Mesh mesh = shapes::irregular_sphere(42, {0.3, 0.3, 5});
    mesh.faces.resize(mesh.faces.size() - 3);
    mesh = shapes::join(mesh, shapes::tetrahedron(), {3, 0, 0});
    const auto last = static_cast<Index>(mesh.positions.size()) - 1;
    mesh.faces.push_back({last, 0, 1});  // a fin that touches both parts
    mesh.positions.push_back({0, 3, 0});
    return mesh;
}

Layer small_layer(Mesh mesh) {
    Layer layer = fixtures::with_everything(std::move(mesh), fixtures::random_value);
    layer.selected_vertex.assign(layer.mesh.positions.size(), 0);
    std::fill_n(layer.selected_vertex.begin(), 20, 1);
    layer.faux_edges.assign(layer.mesh.faces.size(), 0);
    for (std::size_t f = 0; f < layer.faux_edges.size(); f += 2) layer.faux_edges[f] = 1;
    layer.selected_edges = layer.faux_edges;
    return layer;
}

std::vector<double> run(const Filter& filter, const Layer& layer, const std::map<std::string, double>& values,
                        const Progress& progress = Progress()) {
    Session session;
    session.progress = progress;
    return fixtures::numbers(plugin::run(filter, layer, session, values));
}

class FilterFaults : public testing::TestWithParam<const Filter*> {
protected:
    const Filter& filter() const { return *GetParam(); }
    const Layer layer = small_layer(suited(filter(), small_mesh()));

    /// Lets every `stride`-th allocation fail. @return allocations of a call that succeeds
    long starve(const Variant& variant, Shortage shortage, long first, long stride) {
        const std::vector<double> expected = run(filter(), layer, variant.values);
        for (long i = first;; i += stride) {
            bool refused = false;
            std::vector<double> result;
            {
                Session session;
                faults::fail_at(i, shortage);
                try {
                    const Result r = plugin::run(filter(), layer, session, variant.values);
                    faults::stop();
                    result = fixtures::numbers(r);
                } catch (const std::bad_alloc&) {
                    refused = true;
                }
            }
            const long made = faults::stop();
            if (!refused) {
                EXPECT_EQ(result, expected) << "after allocation " << i << " failed";
                if (made <= i) return made;
            }
        }
    }
};

}  // namespace

TEST(ArrayFaults, NoMemoryForALargeArrayIsAnErrorAndTheNextOneWorks) {
    constexpr std::size_t large = 5 << 20;
    Array<char> kept(large, 'a'), after;
    faults::fail_at(0, Shortage::once, faults::Memory::large);
    EXPECT_THROW(kept.resize(2 * large), std::bad_alloc);
    EXPECT_NO_THROW(after.resize(2 * large));
    EXPECT_EQ(faults::stop(), 2);
    EXPECT_EQ(kept, Array<char>(large, 'a'));
    std::fill(after.begin(), after.end(), 'b');
}

TEST_P(FilterFaults, NoMemoryAtAnyAllocationIsAnErrorAndTheNextCallWorks) {
    const fixtures::Threads one(1);
    const auto calls = variants(filter(), layer);
    faults::count();
    run(filter(), layer, calls[0].values);
    const long stride = faults::stop() / tried + 1;  // all of them, but of filters that make thousands
    EXPECT_GT(starve(calls[0], Shortage::once, 0, stride), 10) << "counts no allocations";
    starve(calls[0], Shortage::lasting, 0, stride);
}

TEST_P(FilterFaults, NoMemoryInAnyVariantIsAnError) {
    const fixtures::Threads one(1);
    long first = 0;
    for (const Variant& variant : variants(filter(), layer)) {
        faults::count();
        try {
            run(filter(), layer, variant.values);
        } catch (const InputError&) {
            faults::stop();
            continue;  // nothing to do with these values
        }
        const long stride = std::max(every, faults::stop() / tried_of_variant + 1);
        SCOPED_TRACE(variant.name);
        starve(variant, Shortage::once, 7 * ++first % stride, stride);
    }
}

TEST_P(FilterFaults, NoMemoryInAnyThreadIsAnErrorAndTheThreadsGoOn) {
    const fixtures::Threads two(2);
    // Enough for several chunks in a loop.
    const Mesh mesh = suited(filter(), shapes::irregular_sphere(5000, {}));
    const Layer large = fixtures::with_everything(mesh, fixtures::random_value);
    std::map<std::string, double> values;
    if (wants_grid(filter())) values = variants(filter(), large)[0].values;
    const std::vector<double> expected = run(filter(), large, values);
    long made = 0;
    {
        Session session;
        faults::count();
        plugin::run(filter(), large, session, values);
        made = faults::stop();
    }
    for (int i = 0; i < 12; ++i) {
        Session session;
        faults::fail_at(made * i / 12 + i);
        try {
            plugin::run(filter(), large, session, values);
        } catch (const std::bad_alloc&) {
        }
        faults::stop();
    }
    EXPECT_EQ(run(filter(), large, values), expected);
}

TEST_P(FilterFaults, StoppingAtAnyReportEndsTheCall) {
    for (const Variant& variant : variants(filter(), layer)) {
        SCOPED_TRACE(variant.name);
        int reports = 0;
        try {
            run(filter(), layer, variant.values, Progress([&](int percent, const char* what) {
                    EXPECT_TRUE(percent >= 0 && percent <= 100 && what && *what) << percent;
                    return ++reports > 0;
                }));
        } catch (const InputError&) {
            continue;
        }
        EXPECT_GT(reports, 0);
        for (int stop_at = 0; stop_at < reports; ++stop_at) {
            int seen = 0;
            EXPECT_THROW(
                run(filter(), layer, variant.values, Progress([&](int, const char*) { return seen++ != stop_at; })),
                Cancelled);
            EXPECT_EQ(seen, stop_at + 1) << "went on after the stop";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(AllPlugins, FilterFaults, testing::ValuesIn(all_filters()),
                         [](const auto& info) { return info.param->python_name; });

}  // namespace multires
