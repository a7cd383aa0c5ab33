#include "all_tables.h"

#include <gtest/gtest.h>

#include <regex>
#include <set>

// What every filter table must keep to, whatever the filter does.

using namespace multires::plugin;

namespace {

struct Row {
    const Plugin* plugin;
    const Filter* filter;
};

std::vector<Row> rows() {
    std::vector<Row> all;
    for (const Plugin* plugin : all_tables())
        for (const Filter& filter : plugin->filters) all.push_back({plugin, &filter});
    return all;
}

class TableRow : public testing::TestWithParam<Row> {
protected:
    const Filter& filter() const { return *GetParam().filter; }
};

/// Checks every parameter it visits; as a reader it would change nothing.
class Checker final : public Parameters {
public:
    void boolean(const char* name, bool&, const Hint& hint) override { check(name, hint); }
    void integer(const char* name, int& value, const Hint& hint) override { in_range(name, value, hint); }
    void real(const char* name, double& value, const Hint& hint) override { in_range(name, value, hint); }
    void slider(const char* name, double& value, const Hint& hint) override {
        in_range(name, value, hint);
        EXPECT_GT(hint.least, -1e300) << name << ": a slider needs two ends";
        EXPECT_LT(hint.most, 1e300) << name << ": a slider needs two ends";
    }
    void text(const char* name, std::string&, const Hint& hint) override { check(name, hint); }
    void choice(const char* name, int& value, const std::vector<std::string>& names, const Hint& hint) override {
        check(name, hint);
        EXPECT_GE(names.size(), 2u) << name;
        EXPECT_GE(value, 0) << name;
        EXPECT_LT(value, static_cast<int>(names.size())) << name;
        EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size()) << name;
    }

private:
    void check(const std::string& name, const Hint& hint) {
        static const std::regex snake_case("[a-z][a-z0-9]*(_[a-z0-9]+)*");
        EXPECT_TRUE(std::regex_match(name, snake_case)) << name;
        EXPECT_TRUE(names_.insert(name).second) << name << " is there twice";
        EXPECT_FALSE(hint.label.empty()) << name;
        EXPECT_FALSE(hint.tooltip.empty()) << name;
    }
    void in_range(const char* name, double value, const Hint& hint) {
        check(name, hint);
        EXPECT_LT(hint.least, hint.most) << name;
        EXPECT_GE(value, hint.least) << name;
        EXPECT_LE(value, hint.most) << name;
    }

    std::set<std::string> names_;
};

}  // namespace

TEST(Tables, NamesAreUnique) {
    std::set<std::string> names, python_names, plugins;
    for (const Plugin* plugin : all_tables()) {
        EXPECT_TRUE(plugins.insert(plugin->name).second) << plugin->name;
        EXPECT_FALSE(plugin->filters.empty()) << plugin->name;
    }
    for (const Row& row : rows()) {
        EXPECT_TRUE(names.insert(row.filter->name).second) << row.filter->name;
        EXPECT_TRUE(python_names.insert(row.filter->python_name).second) << row.filter->python_name;
    }
}

TEST_P(TableRow, NameTellsTheGroup) {
    EXPECT_TRUE(std::regex_match(filter().name, std::regex("Multiresolution: [A-Z0-9].*"))) << filter().name;
    EXPECT_EQ(filter().name.find('&'), std::string::npos) << "hosts strip it to find the action";
}

TEST_P(TableRow, PythonNameStartsWithAVerb) {
    const std::regex verb_first("(apply|compute|create|generate|get|meshing|set|transfer)(_[a-z0-9]+)+");
    EXPECT_TRUE(std::regex_match(filter().python_name, verb_first)) << filter().python_name;
}

TEST_P(TableRow, InfoEndsWithACitation) {
    // Authors in italics, title in bold, then a year, as MeshLab's own filters have it.
    const std::regex citation("[\\s\\S]+<i>[\\s\\S]+</i>[\\s\\S]*<b>[\\s\\S]+</b>[\\s\\S]*(19|20)[0-9]{2}[\\s\\S]*");
    EXPECT_TRUE(std::regex_match(filter().info, citation)) << filter().info;
}

TEST_P(TableRow, MasksHoldPartsThatMakeSense) {
    constexpr std::uint32_t all = (custom_attributes << 1) - 1;
    constexpr std::uint32_t attributes = vertex_quality | vertex_color | vertex_texcoord | wedge_texcoord;
    EXPECT_EQ(filter().needs & ~(faces | attributes), 0u);
    EXPECT_EQ(filter().reads & ~(attributes | custom_attributes), 0u);
    EXPECT_EQ(filter().changes & ~all, 0u);
    EXPECT_TRUE(filter().parameters && filter().run);
}

TEST_P(TableRow, DefaultsWithoutAMeshAreInRange) {
    Checker checker;
    filter().parameters(checker, nullptr);
}

TEST_P(TableRow, DefaultsForATetrahedronAreInRange) {
    multires::Layer layer;
    layer.mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
    layer.mesh.faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    Checker checker;
    filter().parameters(checker, &layer);
}

INSTANTIATE_TEST_SUITE_P(AllPlugins, TableRow, testing::ValuesIn(rows()),
                         [](const auto& info) { return info.param.filter->python_name; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(TableRow);
