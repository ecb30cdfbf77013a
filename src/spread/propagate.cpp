#include "spread/propagate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "base/error.h"
#include "spread/ring.h"
#include "spread/straight_ray.h"

namespace pyroscene::spread {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// Shapes of the periods that are still needed.
class Periods {
public:
    explicit Periods(const Propagation& job) : job_(job), shapes_(job.period_start_s.size()) {}

    [[nodiscard]] std::size_t at(double time_s) const noexcept {
        std::size_t p = first_;
        while (p + 1 < shapes_.size() && job_.period_start_s[p + 1] <= time_s) ++p;
        return p;
    }
    [[nodiscard]] double end_s(std::size_t period) const noexcept {
        return period + 1 < shapes_.size() ? job_.period_start_s[period + 1] : kNever;
    }
    const FireShapes& shapes(std::size_t period) {
        while (made_ <= period) {
            shapes_[made_] = job_.shapes(made_);
            ++made_;
        }
        return shapes_[period];
    }
    /// Whether the weather of a time is still kept.
    [[nodiscard]] bool knows(double time_s) const noexcept { return first_ == 0 || job_.period_start_s[first_] <= time_s; }
    /// Nothing before this time will be asked for again.
    void forget_before(double time_s) {
        for (; first_ + 1 < shapes_.size() && job_.period_start_s[first_ + 1] <= time_s; ++first_) {
            shapes(first_);
            FireShapes().swap(shapes_[first_]);
        }
    }

private:
    const Propagation& job_;
    std::vector<FireShapes> shapes_;
    std::size_t first_ = 0, made_ = 0;
};

/// The work on one fire.
class Front {
public:
    explicit Front(const Propagation& job)
        : job_(job),
          grid_(job.grid),
          periods_(job),
          time_s_(grid_.size(), kNever),
          slowness_(grid_.size()),
          burnt_(grid_.size(), 0),
          parent_(grid_.size(), 0),
          origin_(grid_.size(), 0) {}

    Arrival run() {
        for (std::size_t i = 0; i < job_.seeds.size(); ++i) light(i);
        std::size_t taken = 0;
        while (!queue_.empty()) {
            const auto [time_s, cell] = queue_.top();
            queue_.pop();
            if (time_s > time_s_[cell] || burnt_[cell] != 0) continue;
            if (time_s > job_.end_s) break;
            burnt_[cell] = 1;
            straighten(cell);
            if (++taken % 4096 == 0 && job_.on_progress) job_.on_progress(time_s);
            spread_from(cell);
        }
        return result();
    }

private:
    using Place = std::int32_t;  ///< a cell, or the seed - 1 - place

    struct Entry {
        double time_s;
        std::uint32_t cell;
        bool operator>(const Entry& other) const noexcept {
            return time_s != other.time_s ? time_s > other.time_s : cell > other.cell;
        }
    };

    /// Sets a cell on fire at the end of a ray with a displacement when that is earlier than what is known. `ray_s` is the time of
    /// the whole ray under the shapes of a period; what is left of it when the weather changes is done under the next.
    template <class RayTime>
    void offer(std::size_t cell, Place from, double start_s, double x_m, double y_m, const RayTime& ray_s) {
        constexpr double kWorth_s = 1e-3;  ///< a burnt cell is not taken up again for less
        const auto end = ray_end(start_s, ray_s);
        if (!(end.time_s < time_s_[cell] - (burnt_[cell] != 0 ? kWorth_s : 0.0))) return;
        time_s_[cell] = end.time_s;
        slowness_[cell] = slowness(periods_.shapes(end.period)[cell], x_m, y_m);
        parent_[cell] = from;
        burnt_[cell] = 0;
        queue_.push({end.time_s, static_cast<std::uint32_t>(cell)});
    }

    struct RayEnd {
        double time_s;
        std::size_t period;  ///< whose weather it ends in
    };
    /// When a ray that starts at a time ends; never when it does not before the fire is no longer followed.
    template <class RayTime>
    RayEnd ray_end(double start_s, const RayTime& ray_s) {
        std::size_t period = periods_.at(start_s);
        double left = 1.0, now_s = start_s;
        for (;; ++period) {
            const double whole_s = ray_s(periods_.shapes(period)), end_s = periods_.end_s(period);
            if (now_s + left * whole_s <= end_s) return {now_s + left * whole_s, period};
            if (whole_s < kNever) left -= std::max(0.0, end_s - now_s) / whole_s;
            now_s = end_s;
            if (now_s > job_.end_s) return {kNever, period};
        }
    }

    /// A cell that is taken sees whether the fire would have come earlier straight from where the ray to its parent began: any way is one
    /// that the fire can go, so that the earlier of the two is nearer to the truth. On even ground this is the way from the seed itself,
    /// whatever the shape of the fire.
    void straighten(std::size_t cell) {
        constexpr double kSame_s = 1e-6, kLongest = 100.0;
        const Place parent = parent_[cell], ancestor = parent < 0 ? parent : origin_[static_cast<std::size_t>(parent)];
        origin_[cell] = parent;
        if (ancestor == parent) return;
        const Seed from = place(ancestor), here = place(static_cast<Place>(cell));
        const double dx = here.col - from.col, dy = here.row - from.row;
        if (dx * dx + dy * dy > kLongest * kLongest || !periods_.knows(from.time_s)) return;
        const auto end = ray_end(from.time_s, [&](const FireShapes& shapes) {
            return straight_ray_s(grid_, shapes, {from.col, from.row}, dx, dy);
        });
        if (!(end.time_s <= time_s_[cell] + kSame_s)) return;
        origin_[cell] = ancestor;
        time_s_[cell] = std::min(time_s_[cell], end.time_s);
        slowness_[cell] = slowness(periods_.shapes(end.period)[cell], dx * grid_.cell_m, -dy * grid_.cell_m);
    }

    /// Where and when a ray may begin: the centre of a cell, or the seed - 1 - place.
    [[nodiscard]] Seed place(Place at) const noexcept {
        if (at < 0) return job_.seeds[static_cast<std::size_t>(-1 - at)];
        const int row = at / grid_.cols, col = at % grid_.cols;
        return {col + 0.5, row + 0.5, time_s_[static_cast<std::size_t>(at)]};
    }

    /// Straight rays to the cells around a seed.
    void light(std::size_t number) {
        constexpr int kRadius = 4;
        const Seed& seed = job_.seeds[number];
        const int col = static_cast<int>(std::floor(seed.col)), row = static_cast<int>(std::floor(seed.row));
        for (int r = row - kRadius; r <= row + kRadius; ++r)
            for (int c = col - kRadius; c <= col + kRadius; ++c) {
                const double dx = c + 0.5 - seed.col, dy = r + 0.5 - seed.row;
                if (!grid_.contains(r, c) || std::hypot(dx, dy) > kRadius) continue;
                // A seed in the very centre has no direction; any will do.
                const double x_m = dx * grid_.cell_m, y_m = -dy * grid_.cell_m;
                offer(grid_.index(r, c), static_cast<Place>(-1 - static_cast<std::ptrdiff_t>(number)), seed.time_s,
                      x_m == 0.0 && y_m == 0.0 ? 1e-3 : x_m, y_m, [&](const FireShapes& shapes) {
                          return straight_ray_s(grid_, shapes, {seed.col, seed.row}, dx, dy);
                      });
            }
    }

    /// Mean time of the cells on the ray from a neighbour to a cell; infinite when it cannot pass.
    [[nodiscard]] double ray_s(const FireShapes& shapes, std::size_t cell, std::size_t direction) const noexcept {
        const Move& move = ring_[direction];
        const FireShape* const here = shapes.data() + cell;
        const auto at = [&](Offset o) -> const FireShape& { return here[step_of(o)]; };
        if (move.corner && !at(move.beside[0]).burns() && !at(move.beside[1]).burns()) return kNever;
        double sum_s = 0.0;
        for (int i = 0; i < move.pieces; ++i) {
            const auto& piece = move.piece[static_cast<std::size_t>(i)];
            sum_s += piece.share * at(piece.cell).time_s(x_m(move.from), y_m(move.from));
        }
        return sum_s;
    }
    [[nodiscard]] std::ptrdiff_t step_of(Offset o) const noexcept { return std::ptrdiff_t{o.row} * grid_.cols + o.col; }
    /// Displacement of the ray from a neighbour.
    [[nodiscard]] double x_m(Offset from) const noexcept { return -from.col * grid_.cell_m; }
    [[nodiscard]] double y_m(Offset from) const noexcept { return from.row * grid_.cell_m; }

    /// Offers arrival over the rays from a burnt cell, and from between it and the burnt neighbours of it on the rings of other cells.
    void spread_from(std::size_t from) {
        const int row = static_cast<int>(from / static_cast<std::size_t>(grid_.cols)),
                  col = static_cast<int>(from % static_cast<std::size_t>(grid_.cols));
        periods_.forget_before(time_s_[from]);
        const std::size_t period = periods_.at(time_s_[from]);
        const Now now{periods_.shapes(period), periods_.end_s(period)};
        for (std::size_t d = 0; d < kDirections; ++d) {
            const Offset o = ring_[d].from;
            if (!grid_.contains(row - o.row, col - o.col)) continue;
            const auto cell = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(from) - step_of(o));
            if (hopeful(now, cell, time_s_[from], ring_[d].piece[0].share, x_m(o), y_m(o)))
                offer(cell, static_cast<Place>(from), time_s_[from], x_m(o), y_m(o),
                      [&](const FireShapes& then) { return ray_s(then, cell, d); });
            if (!now.shapes[cell].burns() || (time_s_[cell] <= time_s_[from] && !is_thin(now.shapes[cell]))) continue;
            for (const std::size_t side : {(d + 1) % kDirections, (d + kDirections - 1) % kDirections}) {
                const Offset other = ring_[side].from;
                if (!grid_.contains(row - o.row + other.row, col - o.col + other.col)) continue;
                const auto beside = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(cell) + step_of(other));
                if (burnt_[beside] != 0) reach_between(now, {cell, d, side, from, beside});
            }
        }
    }

    /// Length / width above 2.5: only then can a cell be reached from between two neighbours of which one burns later than it does.
    [[nodiscard]] static bool is_thin(const FireShape& shape) noexcept {
        constexpr float kEccentricitySquared = 0.84F;
        return shape.w_x * shape.w_x + shape.w_y * shape.w_y > kEccentricitySquared * 0.5F * (shape.m_xx + shape.m_yy);
    }

    /// The weather in which a cell passes the fire on.
    struct Now {
        const FireShapes& shapes;
        double end_s;
    };

    /// Whether a ray could bring the fire earlier than what is known: its last piece, in the cell itself, takes time. Weather that
    /// changes before could be faster, so that nothing is known then.
    [[nodiscard]] bool hopeful(const Now& now, std::size_t cell, double start_s, double last_piece, double x,
                               double y) const noexcept {
        const double known_s = time_s_[cell];
        if (known_s > now.end_s || !(known_s < kNever)) return true;
        if (known_s <= start_s) return false;
        return start_s + last_piece * now.shapes[cell].time_s(x, y) < known_s;
    }

    /// Two burnt neighbours of a cell, next to each other on its ring.
    struct Pair {
        std::size_t cell, direction, side, from, beside;
    };

    /// The ray to a cell from the best point between two burnt neighbours: the least of t0 + step s + sqrt(a s2 + 2 b s + c) - w v(s).
    void reach_between(const Now& now, const Pair& pair) {
        const FireShape& shape = now.shapes[pair.cell];
        const Offset one = ring_[pair.direction].from, other = ring_[pair.side].from;
        const double x = x_m(one), y = y_m(one), dx = x_m(other) - x, dy = y_m(other) - y;
        const double start = time_s_[pair.from], step = time_s_[pair.beside] - start;
        if (time_s_[pair.cell] <= std::min(start, start + step)) return;
        const double a = shape.m_xx * dx * dx + 2.0 * shape.m_xy * dx * dy + shape.m_yy * dy * dy;
        const double b = (shape.m_xx * dx + shape.m_xy * dy) * x + (shape.m_xy * dx + shape.m_yy * dy) * y;
        const double c = shape.m_xx * x * x + 2.0 * shape.m_xy * x * y + shape.m_yy * y * y;
        const double d = step - shape.w_x * dx - shape.w_y * dy;
        // The derivative along the edge is negative at one end and positive at the other, or the least is an end.
        if (!(d * std::sqrt(c) + b < 0.0) || !(d * std::sqrt(a + 2.0 * b + c) + a + b > 0.0) || !(d * d < a)) return;
        const double share = -d * std::sqrt(std::max(0.0, a * c - b * b)) / (a * std::sqrt(a - d * d)) - b / a;
        if (!(share > 0.0 && share < 1.0)) return;
        const double ray_x = x + share * dx, ray_y = y + share * dy;
        const double between = start + share * step + bend_s(pair, -dx, -dy, step, share);
        const double last_piece = std::min(ring_[pair.direction].piece[0].share, ring_[pair.side].piece[0].share);
        if (!hopeful(now, pair.cell, between, last_piece, ray_x, ray_y)) return;
        offer(pair.cell, static_cast<Place>(share < 0.5 ? pair.from : pair.beside), between, ray_x, ray_y,
              [&](const FireShapes& then) {
                  const FireShape& own = then[pair.cell];
                  const double t = std::lerp(ray_s(then, pair.cell, pair.direction) / own.time_s(x, y),
                                             ray_s(then, pair.cell, pair.side) / own.time_s(x + dx, y + dy), share) *
                                   own.time_s(ray_x, ray_y);
                  return std::isnan(t) ? kNever : t;
              });
    }

    /// What a cubic through both times with both slownesses adds to the straight line between two cells, limited.
    [[nodiscard]] double bend_s(const Pair& pair, double x_m, double y_m, double step, double share) const noexcept {
        if (origin_[pair.from] == origin_[pair.beside]) return 0.0;  // the straight way is looked at when the cell is taken
        const Slowness &p = slowness_[pair.from], &q = slowness_[pair.beside];
        const double first = p.x * x_m + p.y * y_m - step, second = q.x * x_m + q.y * y_m - step;
        if (first * second >= 0.0) return 0.0;  // no arc: the slownesses do not belong to one front
        constexpr double kLimit = 2.0;          // of the weaker end's curvature, which keeps thin ellipses stable
        const double cubic = std::abs(first) * (1.0 - share) + std::abs(second) * share;
        return std::copysign(share * (1.0 - share) * std::min(cubic, kLimit * std::min(std::abs(first), std::abs(second))),
                             first);
    }

    Arrival result() {
        Arrival out{Raster<float>(grid_, "arrival_time", "s", std::numeric_limits<float>::quiet_NaN()),
                    std::move(slowness_)};
        for (std::size_t i = 0; i < time_s_.size(); ++i)
            if (time_s_[i] <= job_.end_s) out.time_s.values[i] = static_cast<float>(time_s_[i]);
        return out;
    }

    const Propagation& job_;
    const MapGrid& grid_;
    const std::array<Move, kDirections>& ring_ = ring();
    Periods periods_;
    std::vector<double> time_s_;
    std::vector<Slowness> slowness_;
    std::vector<std::uint8_t> burnt_;
    std::vector<Place> parent_, origin_;  ///< whence the last ray to a cell came; where the straight way to it begins
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

Arrival propagate(const Propagation& job) {
    if (job.period_start_s.empty()) throw input_error("spread", "no weather is given");
    return Front(job).run();
}

}  // namespace pyroscene::spread
