#include "host_documents.h"

#include <cstdio>
#include <cstdlib>
#include <exception>

// Loads the plugins, calls every filter, each time on a new document, unloads them and ends; for valgrind, to count
// what is lost and find what is touched that may not be:
//   multires_repeat_filters CALLS [keep]
// With keep, the plugins stay and a document with a kept pyramid is still there when the process ends.

namespace multires::host_tests {
namespace {

void call(const Action& action, MeshDocument& document) {
    unsigned changed = 0;
    action.plugin->applyFilter(action.action, small_parameters_of(action, document), document, changed, nullptr);
}

void repeat(int calls) {
    for (int i = 0; i < calls; ++i)
        for (const Action& action : actions()) {
            MeshDocument document;
            fill(document, action);
            call(action, document);
        }
}

}  // namespace
}  // namespace multires::host_tests

int main(int argc, char** argv) {
    using namespace multires::host_tests;
    const int calls = argc > 1 ? std::atoi(argv[1]) : 0;
    static MeshDocument* left = nullptr;
    try {
        repeat(calls);
        std::printf("%zu filters, %d calls each\n", actions().size(), calls);
        if (argc > 2) {
            left = new MeshDocument;
            const Action& action = action_named("compute_multires_pyramid");
            fill(*left, action);
            call(action, *left);
        } else {
            unload();
        }
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
    return calls > 0 ? 0 : 1;
}
