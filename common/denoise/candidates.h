#pragma once

#include "denoise/along_normals.h"
#include "denoise/risk.h"

#include <array>
#include <functional>
#include <optional>

/// The denoised versions of a surface between which the risk decides.
namespace multires {

/// Linear low passes, Taubin's steps: along the normals with equal weights and with cotangents, and of the places with
/// equal weights, of which only what goes along the normals is used. While the places are smoothed their sampling
/// becomes even, so that bends do not look like details where it is not; where it is by design cotangents are better.
constexpr std::array<int, 6> low_pass_steps = {1, 2, 5, 12, 30, 80};
/// Wiener filters: between the low passes, each band shrunk locally by 1 - severity x noise energy / energy.
constexpr std::array<double, 3> wiener_severity = {1, 1.5, 2.5};
/// The scale space of the normals (normals/normal_field.h) with these strengths.
constexpr std::array<double, 2> field_strength = {0.6, 1};
/// Steps of guided normals (normals/guided_normals.h) after the last of these.
constexpr std::array<int, 2> guided_steps_after = {2, 8};

enum class Smoother { equal, cotangent, spatial };
constexpr std::array<Smoother, 3> smoothers = {Smoother::equal, Smoother::cotangent, Smoother::spatial};

enum class Family { low_pass, wiener, normal_field, guided_normals };

/// What one candidate is; `index` into the family's array.
struct Candidate {
    Family family;
    int index;
    Smoother smoother = Smoother::equal;  ///< of low passes and Wiener filters

    bool is(Family f, Smoother s) const { return family == f && smoother == s; }
    bool keeps_creases() const { return family == Family::normal_field || family == Family::guided_normals; }
};

/// All of them, in the order of their weights.
std::vector<Candidate> all_candidates();

/// How much of a blend are candidates that keep creases: normal fields and guided normals.
/// @param weights  of all_candidates(); those of candidates missing at the end are 0
double sharp_share(const Eigen::VectorXd& weights);

/// Weights of the candidates: of each class of vertices, and how much each vertex is of each class.
class LocalWeights {
public:
    /// @param of_class  one at least; those of candidates missing at the end are 0
    /// @param share     #V: of the classes, sums of 1; empty if there is one class
    LocalWeights(const std::vector<Eigen::VectorXd>& of_class, std::vector<std::array<double, 3>> share);

    bool any(std::size_t candidate) const;
    double at(std::size_t candidate, std::size_t v) const {
        if (share_.empty()) return of_class_[0][static_cast<Eigen::Index>(candidate)];
        double sum = 0;
        for (std::size_t c = 0; c < of_class_.size(); ++c)
            sum += share_[v][c] * of_class_[c][static_cast<Eigen::Index>(candidate)];
        return sum;
    }

private:
    std::vector<Eigen::VectorXd> of_class_;
    std::vector<std::array<double, 3>> share_;
};

/// A surface that is to be denoised, with what its candidates share.
class CandidateMaker {
public:
    /// @param smoothing  steps of Taubin's low pass on the surface whose normals are directions, and cotangents weights
    /// @param deviation  #V: of the noise along the normals, mesh units; 0: the vertex stays
    CandidateMaker(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                   int smoothing, const std::vector<double>& deviation);

    const Array<Vec3>& normal() const { return normal_; }
    const std::vector<double>& weight() const { return weight_; }
    const std::vector<double>& probe() const { return probe_; }
    const FaceGraph& graph() const;

    struct Responses {
        std::vector<Response> all;  ///< in the order of all_candidates()
        Positions field;            ///< the mesh after the last of the normal fields
    };
    /// Move and response of all candidates but the guided normals, which come last.
    /// @param tick  called with the fraction done; may throw to stop
    Responses responses(const std::function<void(double)>& tick) const;
    /// Those of the guided normals: they begin where the normal field ends.
    void add_guided(Responses& responses, const std::function<void(double)>& tick) const;

    /// Nearly the move and response of some blends, in much less time: for all that keeps creases stands the last of
    /// the normal fields.
    std::vector<Response> responses_like(const std::vector<Eigen::VectorXd>& blends,
                                         const std::function<void(double)>& tick) const;

    /// Where a blend of candidates puts the vertices. Candidates of weight 0 are not made.
    Positions blend(const LocalWeights& weights, const std::function<void(double)>& tick) const;

private:
    /// What is smoothed: the surface; for gains of bands also a sample of noise, and how both answer the probe.
    enum class Channels { surface = 1, surface_noise = 2, surface_probe_noise = 3 };
    using LowPasses = std::vector<std::vector<double>>;  ///< moves, #V by channels each
    /// @param levels  the first so many of low_pass_steps
    LowPasses low_passes(Smoother smoother, std::size_t levels, Channels channels) const;
    LowPasses along_normals(const std::vector<double>& weight, std::size_t levels, Channels channels) const;
    template <int channels>
    LowPasses spatial(std::size_t levels) const;
    std::vector<double> samples(Channels channels) const;  ///< heights that the low passes start with
    Response of_low_pass(const std::vector<double>& low) const;
    using Add = std::function<void(std::size_t candidate, const Response& moves)>;
    /// Makes the linear candidates that have weights, and those made of them.
    /// @param probed  with their answer to the probe
    void add_heights(const LocalWeights& weights, Smoother smoother, bool probed, const Add& add) const;
    /// What lies between two low passes, of two or three channels.
    struct Band {
        std::vector<double> detail;  ///< #V by channels
        /// #V by channels, local means: of the surface, if there is a probe its product with that, of noise
        std::vector<double> energy;
        std::vector<double> noise;  ///< #V: the last, averaged over more
    };
    std::vector<Band> bands(const LowPasses& low) const;
    /// Without a probe there is no answer to it.
    Response wiener(const LowPasses& low, const std::vector<Band>& bands, double severity) const;
    bool moves(std::size_t v) const { return deviation_[v] > 0; }  ///< where there is no noise nothing is done
    std::vector<std::uint8_t> faces_without_noise() const;         ///< #F; empty: there are none
    Positions field(const Positions& from, double strength, const std::function<void(double)>& tick) const;
    double side() const;
    Positions pushed(double length) const;
    Response response_of(const Positions& after, const Positions& after_push, double length) const;

    const Faces& faces_;
    const Positions& positions_;
    const Incidence& at_;
    const Neighbours& near_;
    const std::vector<double>& deviation_;
    Array<Vec3> normal_;          ///< #V by 3
    std::vector<double> weight_;  ///< #entries
    std::vector<double> probe_;
    mutable std::optional<FaceGraph> graph_;
};

}  // namespace multires
