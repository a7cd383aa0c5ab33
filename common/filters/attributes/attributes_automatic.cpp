#include "filters/attributes/attributes_automatic.h"

#include "base/number.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace multires {
namespace {

std::string short_text(double value) { return number(value, 3); }

std::string percent(double share) { return short_text(100 * share) + " %"; }

/// What was found and done, in words.
std::string summary(const std::string& label, const DenoisedValues& d, double noise) {
    std::string text = label + ": ";
    if (d.impulses > 0) text += "impulses at " + std::to_string(d.impulses) + " vertices were replaced; ";
    if (d.step > 0) text += "values were rounded to steps of " + short_text(d.step) + "; ";
    if (!(noise > 0)) return text + "no noise that could be told from what is there.";
    text += "noise of " + short_text(noise);
    if (d.largest_noise > 1.2 * d.smallest_noise)
        text += " (" + short_text(d.smallest_noise) + " to " + short_text(d.largest_noise) + ")";
    const double blended = d.low_pass + d.wiener + d.total_variation;
    if (blended > 0)
        return text + "; low passes " + percent(d.low_pass) + ", Wiener filters " + percent(d.wiener) +
               ", total variation " + percent(d.total_variation) + "; expected error " + short_text(d.rms_before) +
               ", now " + short_text(d.rms_after) + ".";
    return text + (d.step > 0 ? "." : "; nothing that was tried is expected to come clearly nearer to the truth.");
}

void report_values(const std::string& label, const DenoisedValues& d, Report& report) {
    double squares = 0;
    for (const double n : d.noise) squares += n * n / static_cast<double>(d.noise.size());
    const double noise = std::sqrt(squares);
    report.add(label + "_noise", noise);
    report.add(label + "_noise_least", d.smallest_noise);
    report.add(label + "_noise_most", d.largest_noise);
    report.add(label + "_impulses", static_cast<int>(d.impulses));
    report.add(label + "_rounding_step", d.step);
    report.add(label + "_estimated_rms_before", d.rms_before);
    report.add(label + "_estimated_rms_after", d.rms_after);
    report.add(label + "_share_low_pass", d.low_pass);
    report.add(label + "_share_wiener", d.wiener);
    report.add(label + "_share_total_variation", d.total_variation);
    report.say(summary(label, d, noise));
}

/// Channels [begin, begin + width) of a field, and back.
std::vector<double> part_of(const Field& field, int begin, int width) {
    std::vector<double> out;
    out.reserve(static_cast<std::size_t>(field.rows()) * width);
    for (Index r = 0; r < field.rows(); ++r) out.insert(out.end(), field.row(r) + begin, field.row(r) + begin + width);
    return out;
}

void set_part(Field& field, int begin, int width, const std::vector<double>& values) {
    for (Index r = 0; r < field.rows(); ++r)
        std::copy_n(values.data() + static_cast<std::size_t>(r) * width, width, field.row(r) + begin);
}

}  // namespace

Field denoised_automatically(const ValueSurface& surface, const Channels& channels, double strength, Report& report,
                             const std::function<void(double)>& tick) {
    const bool color = channels.field.width == 4;
    const int width = color ? 3 : channels.field.width;
    const double rounding = color ? 0.5 : 0;  // colours are whole numbers before and after
    Field after = channels.field;
    const DenoisedValues d = denoise_values(surface, part_of(after, 0, width), width, strength, rounding,
                                            [&](double f) { tick(color ? 0.75 * f : f); });
    set_part(after, 0, width, d.values);
    report_values(channels.label, d, report);
    if (!color) return after;
    const DenoisedValues alpha =
        denoise_values(surface, part_of(after, 3, 1), 1, strength, rounding, [&](double f) { tick(0.75 + 0.25 * f); });
    set_part(after, 3, 1, alpha.values);
    return after;
}

}  // namespace multires
