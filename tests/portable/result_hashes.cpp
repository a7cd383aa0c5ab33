#include "all_tables.h"
#include "attribute_fixtures.h"
#include "filters/result_hash.h"
#include "result_numbers.h"
#include "suited.h"
#include "variants.h"

#include "base/hash.h"

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

// Prints what every filter computes on generated meshes, as hashes: "mesh,filter,options,hash of the result,hash of the
// report". With an argument, of the filters alone whose names hold it. scripts/check_portable.sh holds the outputs of
// other compilers, processors and systems beside one another.

namespace multires {
namespace {

using namespace plugin;

/// On a grid far coarser than a double's: the last bits of sin and cos, which differ between systems, are gone.
double rounded(double x) { return std::round(std::ldexp(x, 24)) / std::ldexp(1, 24); }

Layer sample(Mesh mesh) {
    for (Vec3& p : mesh.positions)
        for (double& x : p) x = rounded(x);
    const auto data = [](Index v, int k) { return rounded(fixtures::random_value(v, k)); };
    return fixtures::marked(fixtures::with_everything(std::move(mesh), data));
}

unsigned long long hash_of(const std::vector<double>& numbers) {
    Hash hash;
    hash.add(numbers);
    return hash.bits64();
}

void print(const std::string& mesh, const Filter& filter, const Layer& layer, const Variant& variant) {
    std::printf("%s,%s,%s,", mesh.c_str(), filter.python_name.c_str(), variant.name.c_str());
    try {
        Session session;
        const Result result = run(filter, layer, session, variant.values);
        std::printf("%.0f,%016llx\n", result_hash(result), hash_of(fixtures::numbers(result)));
    } catch (const InputError& error) {
        std::printf("refused: %s\n", error.what());
    }
}

void print_all(const std::string& mesh, const Mesh& shape, const std::string& part, bool with_variants) {
    for (const Filter* filter : all_filters()) {
        if (filter->python_name.find(part) == std::string::npos) continue;
        const Layer layer = sample(suited(*filter, shape));
        std::vector<Variant> list{{"defaults", {}, ""}};
        if (with_variants) list = variants(*filter, layer);
        for (const Variant& variant : list) print(mesh, *filter, layer, variant);
        std::fflush(stdout);
    }
}

}  // namespace
}  // namespace multires

int main(int argc, char** argv) {
    using namespace multires;
    const std::string part = argc > 1 ? argv[1] : "";
    print_all("sphere", shapes::irregular_sphere(400), part, true);
    print_all("terrain", shapes::terrain(40).mesh, part, false);
    print_all("block", shapes::block(10), part, false);
}
