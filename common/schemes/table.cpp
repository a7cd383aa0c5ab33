#include "schemes/table.h"

#include "base/error.h"

#include <stdexcept>

namespace multires {

SchemeRow roy_scheme();       // burt_adelson.cpp
SchemeRow guskov_scheme();    // burt_adelson.cpp
SchemeRow lazy_scheme();      // lazy.cpp
SchemeRow szczesna_scheme();  // szczesna.cpp
SchemeRow dreger_scheme();    // dreger.cpp

const std::vector<SchemeRow>& schemes() {
    static const std::vector<SchemeRow> all{
        roy_scheme(), guskov_scheme(), lazy_scheme(), szczesna_scheme(), dreger_scheme(),
    };
    return all;
}

int scheme_named(const std::string& name) {
    for (std::size_t i = 0; i < schemes().size(); ++i)
        if (schemes()[i].name == name) return static_cast<int>(i);
    throw std::invalid_argument("no scheme " + name);
}

void require_starts_anywhere(const SchemeOptions& options) {
    const SchemeRow& row = schemes().at(static_cast<std::size_t>(options.row));
    require(row.capabilities.starts_anywhere,
            "scheme: " + row.name + " does not start from the values of a level, which this takes; choose another one");
}

std::unique_ptr<Scheme> make_scheme(const Hierarchy& hierarchy, const SchemeOptions& options) {
    return schemes().at(static_cast<std::size_t>(options.row)).make(hierarchy, options);
}

}  // namespace multires
