#include "bytes.h"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

// Runs a fuzz target over files and folders of inputs, without a fuzzer: what was once found stays a test. Inputs whose
// names begin with "refused" must be refused; all others must work, or they would test nothing.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

/// @returns false if it works and should not, or the other way round
bool replay(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
    const long before = multires::fuzz::worked;
    std::printf("%s\n", path.c_str());
    std::fflush(stdout);
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    const bool works = multires::fuzz::worked > before, wanted = path.filename().string().rfind("refused", 0) != 0;
    if (works != wanted) std::printf("  %s\n", works ? "should be refused" : "should work");
    return works == wanted;
}

}  // namespace

int main(int argc, char** argv) {
    int files = 0, wrong = 0;
    for (int i = 1; i < argc; ++i)
        for (const auto& entry : std::filesystem::recursive_directory_iterator(argv[i])) {
            if (!entry.is_regular_file()) continue;
            wrong += !replay(entry.path());
            ++files;
        }
    std::printf("%d inputs, %ld of them worked, %d against their name\n", files, multires::fuzz::worked, wrong);
    return wrong == 0 && multires::fuzz::worked > 0 ? 0 : 1;
}
