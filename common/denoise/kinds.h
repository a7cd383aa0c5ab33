#pragma once

#include "denoise/risk.h"

/// Two kinds of surface on one mesh: where one blend of candidates has less risk (risk.h) than another.
namespace multires {

/// A blend of candidates: what it does, and its weights' sum.
struct Blend {
    Response response;
    double total = 0;
};

/// What the risk of the first blend's differences along edges is larger by than that of the second: means over the
/// edges of each vertex, in units of the noise's own.
/// @param deviation, probe, core  as for risks(); what does not count is 0
/// @returns #V
std::vector<double> risk_difference(const Neighbours& near, const Blend& first, const Blend& second,
                                    const std::vector<double>& deviation, const std::vector<double>& probe,
                                    const std::vector<std::uint8_t>& core);

/// Share of the first blend in each vertex: 1 where it is better by two standard errors or more in the mean of some
/// hundred vertices around, 0 where the second is, smooth in between.
/// @param difference  #V: risk_difference()
/// Cost: some averaging steps
std::vector<double> shares_of_first(const Neighbours& near, const std::vector<double>& difference);

/// True if a mean difference is below 0 by two standard errors, and by enough of the noise to be worth it.
bool certainly_less(const std::vector<double>& difference, const std::vector<std::uint8_t>& core);

}  // namespace multires
