#pragma once

#include "filters/filter.h"

#include <gtest/gtest.h>

#include <string>

namespace multires::fixtures {

/// The value of a key in a report; a failure of the test if it is not there.
template <class T>
T reported(const Result& result, const std::string& key) {
    for (const Report::Entry& e : result.report.entries())
        if (e.key == key) return std::get<T>(e.value);
    ADD_FAILURE() << "no " << key;
    return T();
}

}  // namespace multires::fixtures
