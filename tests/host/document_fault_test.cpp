#include "allocation_faults.h"
#include "document_snapshot.h"
#include "host_documents.h"

#include <gtest/gtest.h>

#include <new>

// All or nothing, in the host: the plugins as MeshLab loads them, on a document with every kind of data. Each
// allocation fails in turn, and each progress report is answered with stop; the document must then be what it was, byte
// for byte, or (where the filter could do without the memory) what it becomes in a call that succeeds.

namespace multires::host_tests {
namespace {

using faults::Memory;
using faults::Shortage;

/// One call on a document of its own.
struct Case {
    explicit Case(const Action& a, Content content = Content::everything) : action(a) {
        fill(document, action, content);
        list = small_parameters_of(action, document);
        if (content != Content::bare) call("compute_multires_pyramid");  // of other options
        before = snapshot(document);
    }

    void call(const std::string& name) {
        const Action pyramid = action_named(name);
        unsigned changed = 0;
        pyramid.plugin->applyFilter(pyramid.action, parameters_of(pyramid, document), document, changed, nullptr);
    }

    void run(vcg::CallBackPos* callback = nullptr) {
        unsigned changed = 0;
        action.plugin->applyFilter(action.action, list, document, changed, callback);
    }

    Action action;
    MeshDocument document;
    RichParameterList list;
    Snapshot before;
};

class DocumentFaults : public testing::TestWithParam<Action> {
protected:
    /// Lets every allocation fail in turn; of thousands, some hundreds; for large documents, some of the large ones.
    void starve(Shortage shortage, Content content = Content::everything) {
        const bool large = content == Content::large;
        const Memory memory = large ? Memory::large : Memory::all;
        auto c = std::make_unique<Case>(GetParam(), content);
        faults::count(memory);
        c->run();
        const long tried = large ? 4 : shortage == Shortage::once && content == Content::everything ? 400 : 150;
        const long step = faults::stop() / tried + 1;
        const Snapshot done = snapshot(c->document);
        const std::string& name = GetParam().name;
        const bool may_find_nothing =  // without creases; or it only reports
            name == "compute_selection_multires_features" || name == "compute_multires_grid" ||
            name == "compute_multires_watermark";
        EXPECT_TRUE(done != c->before || done.cached != c->before.cached || may_find_nothing)
            << "the filter changes nothing at all, not even the kept pyramid";
        c = std::make_unique<Case>(GetParam(), content);
        int refusals = 0, successes = 0;
        for (long i = 0;; i += step) {
            bool refused = true;
            std::string message = "std::bad_alloc";
            faults::fail_at(i, shortage, memory);
            try {
                c->run();
                refused = false;
            } catch (const MLException& e) {
                faults::stop();
                message = e.what();
            } catch (const std::bad_alloc&) {
            }
            const long made = faults::stop();
            if (refused) {
                ++refusals;
                ASSERT_TRUE(snapshot(c->document) == c->before) << "allocation " << i;
                EXPECT_TRUE(message.find("Not enough memory") == 0 ||
                            (shortage == Shortage::lasting && message == "std::bad_alloc"))
                    << message;
                continue;
            }
            ASSERT_TRUE(snapshot(c->document).equals(done)) << "allocation " << i;
            if (made <= i) break;
            ++successes;
            c = std::make_unique<Case>(GetParam(), content);
        }
        EXPECT_GT(refusals, large ? 2 : 30);
        EXPECT_LT(successes, refusals);
    }
};

int reports, stop_at;

bool count_reports(int /*percent*/, const char* /*what*/) { return reports++ != stop_at; }

}  // namespace

TEST_P(DocumentFaults, NoMemoryAtAnyAllocationLeavesTheDocument) { starve(Shortage::once); }

TEST_P(DocumentFaults, NoMemoryLeavesADocumentWithoutData) {
    try {
        Case(GetParam(), Content::bare).run();
    } catch (const MLException& e) {
        EXPECT_TRUE(std::string(e.what()).find("has no") != std::string::npos) << e.what();
        return;  // a filter of attributes
    }
    starve(Shortage::once, Content::bare);
}

TEST_P(DocumentFaults, NoMemoryFromAnyAllocationOnLeavesTheDocument) { starve(Shortage::lasting); }

TEST_P(DocumentFaults, NoMemoryForLargeArraysLeavesTheDocument) { starve(Shortage::lasting, Content::large); }

TEST_P(DocumentFaults, StoppingAtAnyReportLeavesTheDocument) {
    reports = 0, stop_at = -1;
    Case(GetParam()).run(count_reports);
    const int all = reports;
    ASSERT_GT(all, 0);
    Case c(GetParam());
    for (stop_at = 0; stop_at < all; ++stop_at) {
        reports = 0;
        try {
            c.run(count_reports);
            // The host hears of the same percentage only ten times a second: there may be fewer reports this time.
            ASSERT_LE(reports, stop_at);
            break;
        } catch (const MLException& e) {
            EXPECT_STREQ(e.what(), "Cancelled: nothing was changed.");
        }
        ASSERT_TRUE(snapshot(c.document) == c.before) << "report " << stop_at;
    }
}

INSTANTIATE_TEST_SUITE_P(AllPlugins, DocumentFaults, testing::ValuesIn(actions()),
                         [](const auto& info) { return info.param.name; });

}  // namespace multires::host_tests
