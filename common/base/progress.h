#pragma once

#include <functional>
#include <stdexcept>
#include <utility>

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

    /// Reports to the host; throws Cancelled if it answers false.
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

}  // namespace multires
