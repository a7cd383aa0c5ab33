#pragma once

#include "mesh/error.h"
#include "mesh/layer.h"

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// What every filter gets and gives. A filter is a pure function of a layer and its options: it returns a Result and
/// never touches the host's document, so that a failure or a cancel leaves everything as it was.
namespace multires {

/// The host's progress callback said stop.
struct Cancelled : std::runtime_error {
    Cancelled() : std::runtime_error("cancelled") {}
};

/// Progress of one filter call, in fractions of the whole; called from the main thread only.
class Progress {
public:
    using Callback = std::function<bool(int percent, const char* what)>;

    Progress() = default;
    explicit Progress(Callback callback) : callback_(std::move(callback)) {}

    /// Tells the host; throws Cancelled if it answers false.
    void report(double fraction, const char* what) const {
        const double whole = begin_ + (end_ - begin_) * fraction;
        if (callback_ && !callback_(static_cast<int>(100 * whole), what)) throw Cancelled();
    }

    /// A Progress for the part [begin, end] of this one.
    Progress part(double begin, double end) const {
        Progress p(*this);
        p.begin_ = begin_ + (end_ - begin_) * begin;
        p.end_ = begin_ + (end_ - begin_) * end;
        return p;
    }

private:
    Callback callback_;
    double begin_ = 0, end_ = 1;
};

/// Numbers a filter returns, in the order they are to be shown; keys are snake_case.
class Report {
public:
    using Value = std::variant<bool, int, double, std::vector<double>>;
    struct Entry {
        std::string key;
        Value value;
        std::string unit;  ///< "", "mesh units", "percent", ...
    };

    void add(std::string key, Value value, std::string unit = "") {
        entries_.push_back({std::move(key), std::move(value), std::move(unit)});
    }
    /// A line for the host's log, beside the numbers.
    void say(std::string line) { lines_.push_back(std::move(line)); }

    const std::vector<Entry>& entries() const { return entries_; }
    const std::vector<std::string>& lines() const { return lines_; }

private:
    std::vector<Entry> entries_;
    std::vector<std::string> lines_;
};

/// What a filter wants changed. Absent parts stay as they are; the host writes all of it or nothing.
struct Result {
    std::optional<Positions> positions;          ///< #V by 3
    std::optional<std::vector<double>> quality;  ///< #V, becomes the vertex quality
    std::vector<Attribute> attributes;           ///< new values of attributes given in the layer
    std::optional<std::vector<Wedge>> wedges;    ///< 3 #F, new texture coordinates of the faces' corners
    std::optional<DerivedMesh> layer;            ///< becomes a new layer of the document
    Report report;
};

class KeptPyramid;
class Original;

/// The part of a call that outlives it: progress, and what travels with the mesh.
struct Session {
    Progress progress;
    /// The pyramid kept with the layer by an earlier call of any of our plugins; may be null or stale (its content
    /// hash decides). A filter that builds one puts it here; the host keeps it with the mesh if the call succeeds.
    std::shared_ptr<const KeptPyramid> pyramid;
    /// The shape the layer had before an earlier call of any of our plugins first moved it; null if none did. The host
    /// keeps it up to date (see original.h).
    std::shared_ptr<const Original> original;
};

}  // namespace multires
