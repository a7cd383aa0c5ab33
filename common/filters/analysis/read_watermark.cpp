#include "filters/analysis/read_watermark.h"

#include "filters/placement.h"
#include "mesh/validation.h"
#include "watermark/reading.h"

#include <algorithm>
#include <optional>

namespace multires {
namespace {

constexpr double sure = 0.99;

const Layer& original_of(const Inputs& inputs, const ReadWatermarkOptions& options) {
    const Layer& original = inputs.other(options.original, "original");
    require(&original != &inputs.current, "original: it is the current layer itself; choose another one");
    try {
        require_usable(original.mesh);
    } catch (const InputError& e) {
        throw InputError(std::string("original: ") + e.what());
    }
    return original;
}

Carriers carriers_of(const Mesh& original) {
    try {
        return Carriers(original);
    } catch (const InputError& e) {
        throw InputError(std::string("original: ") + e.what());
    }
}

void report_reading(const Reading& reading, const std::optional<Message>& expected, Report& report) {
    const auto certain =
        std::count_if(reading.confidence.begin(), reading.confidence.end(), [](double c) { return c > sure; });
    report.add("bits", std::vector<double>(reading.message.begin(), reading.message.end()));
    report.add("confidence", reading.confidence);
    report.add("sure_bits", static_cast<int>(certain));
    report.add("probability_unmarked", reading.probability_unmarked);
    if (expected) {
        int errors = 0;
        for (int i = 0; i < message_bits; ++i) errors += reading.message[i] != (*expected)[i];
        report.add("bit_errors", errors);
    }
    report.say("Message " + text_of(reading.message) + ", " + std::to_string(certain) + " of 64 bits sure");
}

}  // namespace

Result read_watermark(const Inputs& inputs, const ReadWatermarkOptions& options, Session& session) {
    require_usable(inputs.current.mesh);
    const Layer& original = original_of(inputs, options);
    std::optional<Message> expected;
    if (!options.expected.empty()) expected = message_of(options.expected, "expected");
    session.progress.report(0, "Placing the carriers");
    const Carriers carriers = carriers_of(original.mesh);
    const Mesh mesh{in_layer(inputs.current, original, "the current layer"), inputs.current.mesh.faces};
    const CarrierValues values = read_carriers(mesh, original.mesh, carriers, session.progress.part(0.2, 0.95));
    session.progress.report(0.95, "Decoding");
    Result result;
    report_reading(decode(values, assignment(options.key)), expected, result.report);
    result.report.add("carriers_seen", values.seen);
    result.report.add("scale", values.scale);
    result.report.add("smoothing", values.smoothing);
    result.report.add("rms_offset", values.rms_offset, "mesh units");
    return result;
}

}  // namespace multires
