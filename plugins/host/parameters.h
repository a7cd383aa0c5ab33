#pragma once

#include "host/api.h"

namespace multires::host {

/// The parameters of `filter` as the host shows them, with defaults for `layer` (null: no mesh).
/// Where the defaults cannot be derived from the layer (it is bad input, say), the fixed ones are given: what is wrong
/// with the mesh is told when the filter runs, not when its dialog opens.
RichParameterList declare_parameters(const plugin::Filter& filter, const Layer* layer);

/// Reads parameters back from the host's list. A parameter that the list lacks keeps its default, as does one that
/// the host only rounded to its own precision.
/// Every visit throws InputError naming the parameter for NaN, infinity, or a value outside the hint's range.
class ParameterReader final : public plugin::Parameters {
public:
    using Parameters::choice;

    explicit ParameterReader(const RichParameterList& list) : list_(list) {}
    void boolean(const char* name, bool& value, const plugin::Hint& hint) override;
    void integer(const char* name, int& value, const plugin::Hint& hint) override;
    void real(const char* name, double& value, const plugin::Hint& hint) override;
    void slider(const char* name, double& value, const plugin::Hint& hint) override;
    void choice(const char* name, int& value, const std::vector<std::string>& names, const plugin::Hint& hint) override;
    void text(const char* name, std::string& value, const plugin::Hint& hint) override;

private:
    const RichParameterList& list_;
};

}  // namespace multires::host
