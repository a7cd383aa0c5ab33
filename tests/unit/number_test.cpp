#include "base/number.h"

#include <gtest/gtest.h>

#include <locale>

namespace multires {
namespace {

struct DecimalComma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
};

/// Numbers as Germans write them, as long as it lives.
class CommaLocale {
public:
    CommaLocale() : before_(std::locale::global(std::locale(std::locale::classic(), new DecimalComma))) {}
    ~CommaLocale() { std::locale::global(before_); }
    CommaLocale(const CommaLocale&) = delete;
    CommaLocale& operator=(const CommaLocale&) = delete;

private:
    std::locale before_;
};

TEST(Number, HasAPointWhateverTheLocale) {
    const CommaLocale comma;
    EXPECT_EQ(number(0.5), "0.5");
    EXPECT_EQ(number(12345.678), "12345.7");
    EXPECT_EQ(number(-1.0 / 3, 3), "-0.333");
}

}  // namespace
}  // namespace multires
