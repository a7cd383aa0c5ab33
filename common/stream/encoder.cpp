#include "stream/encoder.h"

#include "measure/distance.h"
#include "stream/columns.h"
#include "stream/decoder.h"
#include "stream/plan.h"

#include <algorithm>
#include <cmath>

namespace multires::stream {
namespace {

/// The box's least corner and the size of a cell.
void choose_grid(const Layer& layer, const EncodeOptions& options, Header& header) {
    Vec3 low(0, 0, 0), high(0, 0, 0);
    bool any = false;
    for (const Vec3& p : layer.mesh.positions) {
        if (!p.allFinite()) continue;
        low = any ? Vec3(low.cwiseMin(p)) : p, high = any ? Vec3(high.cwiseMax(p)) : p;
        any = true;
    }
    const double side = (high - low).maxCoeff();
    require(std::isfinite(side), "the mesh is too large for its box to have a size");
    header.origin = low;
    header.step = side / ((1 << options.bits) - 1);
}

std::vector<Cell> cells_of(const Positions& positions, const Header& header) {
    std::vector<Cell> cells(positions.size(), Cell{});
    const double most = (1 << header.bits) - 1;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!(header.step > 0) || !positions[i].allFinite()) continue;
        for (int k = 0; k < 3; ++k) {
            const double x = std::floor((positions[i][k] - header.origin[k]) / header.step + 0.5);
            cells[i][k] = static_cast<std::int32_t>(std::min(std::max(x, 0.0), most));
        }
    }
    return cells;
}

/// The vertices of the region that is to come first, and those around its faces.
std::vector<std::uint8_t> wanted_first(const Layer& layer, const EncodeOptions& options) {
    if (!options.first) return {};
    std::vector<std::uint8_t> inside, out;
    for (const Vec3& p : layer.mesh.positions) inside.push_back(options.first(p) ? 1 : 0);
    out = inside;
    for (const Face& f : layer.mesh.faces)
        if (inside[f[0]] || inside[f[1]] || inside[f[2]])
            for (const Index v : f) out[v] = 1;
    return out;
}

class Encoder {
public:
    Encoder(const Layer& layer, const EncodeOptions& options, const std::function<void(double)>& tick)
        : layer_(layer), options_(options), tick_(tick) {
        header_.bits = options.bits;
        if (options.grid)
            header_.origin = options.grid->origin, header_.step = options.grid->step;
        else
            choose_grid(layer, options, header_);
        cells_ = cells_of(layer.mesh.positions, header_);
        plan_ = std::make_unique<Plan>(layer.mesh.faces, cells_, wanted_first(layer, options),
                                       [&](double done) { report(0.2 * done); });
        header_.columns = Columns::describe(layer.attributes);
        columns_ = Columns(header_.columns);
    }

    Bytes run() {
        write_base();
        for (std::size_t b = 0; b < plan_->batches(); ++b) write_batch(b);
        refine_until(0);
        write_rest();
        header_.bytes = body_.bytes().size();
        ByteWriter header;
        header_.write(header);
        Bytes out(signature, signature + sizeof signature);
        out.push_back(newest_version);
        for (const Bytes& part : {framed(Piece::header, header.bytes()), body_.bytes()})
            out.insert(out.end(), part.begin(), part.end());
        return out;
    }

private:
    void report(double done) const {
        if (tick_) tick_(done);
    }
    void write(Piece piece, const Bytes& payload) { body_.add(framed(piece, payload)); }

    /// How many bits coarser cells may be before a batch: their rounding adds an eighth to the squared error at most.
    /// In planes, whose vertices predict each other well only where they are not rounded, a fiftieth.
    int bits_less(std::size_t batch) const {
        const double share = plan_->planes() ? 0.02 : 0.12;
        int less = 0;
        if (batch >= plan_->batches()) return 0;
        const double allowed = share * plan_->error_of_first(batch) * plan_->error_of_first(batch);
        while (less < options_.bits - 4 && std::ldexp(1.0, 2 * (less + 1)) / 12 <= allowed) ++less;
        return less;
    }

    void write_base() {
        const int less = bits_less(0);
        plan_->bits_less = less;
        header_.base_bits = options_.bits - less;
        header_.vertices = static_cast<Index>(cells_.size());
        header_.faces = static_cast<Index>(layer_.mesh.faces.size());
        header_.base_vertices = plan_->base_vertices();
        std::vector<Cell> cells;
        for (Index v = 0; v < plan_->base_vertices(); ++v) {
            cells.push_back(plan_->cell(v));
            source_.push_back(plan_->source(v));
        }
        const Faces faces = plan_->base_faces();
        header_.base_faces = static_cast<Index>(faces.size());
        write(Piece::base, packed_base(cells, faces));
        progress_ = std::make_unique<Progress>(cells, faces, header_.base_bits, header_.vertices, newest_version);
        write_attributes();
    }

    void write_batch(std::size_t batch) {
        refine_until(bits_less(batch));
        // A region that is whole must stay as it is, so with one there is no bulge.
        if (!bulge_chosen_ && !options_.first && progress_->mesh().vertices() >= header_.vertices / 8) choose_bulge();
        plan_->begin_batch(batch);
        for (double done = 1; done == 1 || !progress_->at_end_of_batch(); ++done) {
            progress_->visit(coder_, plan_.get());
            ++visits_;
            while (source_.size() < static_cast<std::size_t>(progress_->mesh().vertices()))
                source_.push_back(plan_->source(static_cast<Index>(source_.size())));
            if (coder_.bytes() >= std::max<std::size_t>(least_piece, body_.bytes().size() / 4))
                write_splits(batch, done / progress_->batch_size());
        }
        const bool finer_next = bits_less(batch + 1) < plan_->bits_less;
        const bool whole = batch + 1 == plan_->batches() || batch + 1 == plan_->batches_of_first();
        if (visits_ > 0 && (finer_next || whole)) write_splits(batch, 1);
    }

    void write_splits(std::size_t batch, double done) {
        const double before = plan_->error(batch);
        const double after = batch + 1 < plan_->batches() ? plan_->error(batch + 1) : 0;
        ByteWriter out;
        out.number(visits_);
        visits_ = 0;
        out.word(float_bits(error(before + done * (after - before))) >> 16, 2);
        out.add(coder_.finish());
        write(Piece::splits, out.bytes());
        write_attributes();
        report(0.2 + 0.8 * progress_->mesh().vertices() / header_.vertices);
    }

    /// With the rounding of cells, mesh units.
    double error(double cells) const {
        return header_.step * std::sqrt(cells * cells + std::ldexp(1.0, 2 * plan_->bits_less) / 12);
    }
    static std::uint32_t float_bits(double x) {
        const float f = static_cast<float>(x);
        std::uint32_t bits = 0;
        std::memcpy(&bits, &f, sizeof bits);
        return bits;
    }

    void refine_until(int less) {
        while (plan_->bits_less > less) {
            --plan_->bits_less;
            progress_->refine(coder_, plan_.get());
            write(Piece::refinement, coder_.finish());
        }
    }

    void write_attributes() {
        if (columns_.empty() || columns_.known() == progress_->mesh().vertices()) return;
        write(Piece::attributes,
              columns_.pack(layer_.attributes, source_, progress_->parents(), progress_->mesh().vertices()));
    }

    /// Measures which bulge brings an early prefix nearest to the input.
    void choose_bulge() {
        bulge_chosen_ = true;
        const StarMesh& mesh = progress_->mesh();
        Faces faces;
        for (Index f = 0; f < mesh.faces(); ++f) faces.push_back(mesh.face(f));
        if (faces.empty()) return;
        Positions plain;
        for (const Cell& c : progress_->cells()) plain.push_back(header_.place(c, plan_->bits_less));
        double least = 0;
        constexpr std::size_t samples = 400;  // more take a tenth of a small mesh's time and hardly decide otherwise
        const std::size_t count = cells_.size(), stride = std::max<std::size_t>(1, count / samples);
        std::vector<Index> hint(count / stride + 1, -1);  // a face that was near before makes the search short
        for (const double share : {0.0, 0.125, 0.25}) {
            Positions bulged = plain;
            add_bulge(mesh, plain, share, bulged);
            const SurfaceTree tree(faces, bulged);
            double sum = 0;
            for (std::size_t i = 0; i < count; i += stride) {
                const SurfaceTree::Hit hit = tree.closest(header_.place(cells_[i], 0), hint[i / stride]);
                hint[i / stride] = hit.face;
                sum += hit.squared;
            }
            if (share > 0 && sum >= 0.97 * least) continue;
            least = sum;
            header_.bulge = share;
        }
    }

    void write_rest() {
        if (options_.exact)
            write(Piece::exact, packed_positions(header_, progress_->cells(), source_, layer_.mesh.positions));
        if (layer_.wedges.empty() && !options_.keep_order) {
            write(Piece::end, {});
            return;
        }
        const std::vector<FaceMatch> match = match_faces(progress_->mesh(), source_, layer_.mesh.faces);
        if (!layer_.wedges.empty()) write(Piece::wedges, packed_wedges(progress_->mesh(), match, layer_.wedges));
        if (options_.keep_order) write_order(match);
        write(Piece::end, {});
    }

    void write_order(const std::vector<FaceMatch>& match) {
        std::vector<std::int64_t> numbers;
        for (std::size_t v = 0; v < source_.size(); ++v) {
            const Index parent = progress_->parents()[v];
            const Index like = parent >= 0 ? source_[parent] : v ? source_[v - 1] : 0;
            numbers.push_back(source_[v] - like);
        }
        write(Piece::vertex_order, packed(numbers, 4));
        numbers.clear();
        std::vector<std::int64_t> turns;
        for (std::size_t f = 0; f < match.size(); ++f) {
            numbers.push_back(match[f].face - (f ? match[f - 1].face : 0));
            turns.push_back(match[f].turn);
        }
        Bytes order = packed(numbers, 4);
        const Bytes more = packed(turns, 1);
        order.insert(order.end(), more.begin(), more.end());
        write(Piece::face_order, order);
    }

    static constexpr std::size_t least_piece = 768;

    const Layer& layer_;
    const EncodeOptions& options_;
    const std::function<void(double)>& tick_;
    Header header_;
    std::vector<Cell> cells_;
    std::unique_ptr<Plan> plan_;
    std::unique_ptr<Progress> progress_;
    Columns columns_;
    std::vector<Index> source_;  ///< input vertex of each of the stream's
    std::uint64_t visits_ = 0;   ///< in the piece that is being written
    bool bulge_chosen_ = false;
    BitCoder coder_;
    ByteWriter body_;
};

}  // namespace

Bytes encode(const Layer& layer, const EncodeOptions& options, const std::function<void(double)>& tick) {
    require(options.bits >= 1 && options.bits <= 24, "bits must be between 1 and 24");
    for (const Vec3& p : layer.mesh.positions)
        require(options.exact || p.allFinite(), "a coordinate is not finite: only exact keeps that");
    const auto vertices = static_cast<Index>(layer.mesh.positions.size());
    for (const Face& f : layer.mesh.faces)
        for (const Index v : f) require(v >= 0 && v < vertices, "a face has a vertex that is not there");
    return Encoder(layer, options, tick).run();
}

Bytes region_first(const Decoder& whole, std::function<bool(const Vec3&)> first) {
    require(whole.finished(), "only a whole stream can be put in another order");
    EncodeOptions options;
    options.bits = whole.header().bits;
    options.exact = whole.is_exact();
    options.keep_order = whole.keeps_order();
    options.first = std::move(first);
    options.grid = Grid{whole.header().origin, whole.header().step};
    return encode(whole.layer(), options);
}

}  // namespace multires::stream
