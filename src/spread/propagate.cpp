#include "spread/propagate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "base/error.h"
#include "spread/curved_ray.h"
#include "spread/periods.h"
#include "spread/ring.h"

namespace pyroscene::spread {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// The work on one fire.
class Front {
public:
    explicit Front(const Propagation& job)
        : job_(job),
          grid_(job.grid),
          periods_(job.period_start_s, job.shapes),
          time_s_(grid_.size(), kNever),
          slowness_(grid_.size()),
          burnt_(grid_.size(), 0),
          origins_(job.seeds),
          parent_(grid_.size(), 0),
          beside_(grid_.size(), 0),
          origin_(grid_.size(), 0),
          bend_(grid_.size(), 0.0F) {}

    Arrival run() {
        for (std::size_t i = 0; i < job_.seeds.size(); ++i) light(i);
        std::size_t taken = 0;
        while (!queue_.empty()) {
            const auto [time_s, cell] = queue_.top();
            queue_.pop();
            if (time_s > time_s_[cell] || burnt_[cell] != 0) continue;
            if (time_s > job_.end_s) break;
            burnt_[cell] = 1;
            look_back(cell);
            if (++taken % 4096 == 0 && job_.on_progress) job_.on_progress(time_s);
            spread_from(cell);
        }
        return result();
    }

private:
    using Place = std::int32_t;  ///< a cell, or - 1 - place of origins_

    /// The places between which a ray begins; twice the same when it begins in one.
    struct Parents {
        Place nearer, farther;
    };

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
    void offer(std::size_t cell, Parents from, double start_s, double x_m, double y_m, const RayTime& ray_s) {
        constexpr double kWorth_s = 1e-3;  ///< a burnt cell is not taken up again for less
        const auto end = ray_end(start_s, ray_s);
        if (!(end.time_s < time_s_[cell] - (burnt_[cell] != 0 ? kWorth_s : 0.0))) return;
        time_s_[cell] = end.time_s;
        slowness_[cell] = slowness(periods_.shapes(end.period)[cell], x_m, y_m);
        parent_[cell] = from.nearer;
        beside_[cell] = from.farther;
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

    /// A long way to a cell and when it ends.
    struct Way {
        Place origin;
        double start_s;
        CurvedRay ray;
        RayEnd end;
    };
    Way straight_way(Place origin, std::size_t cell) {
        const Seed from = place(origin), here = place(static_cast<Place>(cell));
        Way found{origin, from.time_s, {{from.col, from.row}, here.col - from.col, here.row - from.row}, {kNever, 0}};
        if (periods_.knows(from.time_s)) found.end = end_of(found.ray, from.time_s);
        return found;
    }
    RayEnd end_of(const CurvedRay& ray, double start_s) {
        return ray_end(start_s, [&](const FireShapes& shapes) { return curved_ray_s(grid_, shapes, ray); });
    }

    /// A cell that is taken sees whether the fire comes as early by one way from where the ways to its parents began: any way is one that
    /// the fire can go, so that the earlier is nearer to the truth. On even ground this is the way from the seed itself, whatever the
    /// shape of the fire; where rates change from cell to cell the way is bent. A way that is long goes on from its middle.
    void look_back(std::size_t cell) {
        constexpr double kSame_s = 1e-6, kSlack = 0.01, kHopeless = 0.01, kLongest = 50.0, kLongestStraight = 100.0;
        const Place parent = parent_[cell], first = origin_of(parent), second = origin_of(beside_[cell]);
        origin_[cell] = parent;
        bend_[cell] = 0.0F;
        if (first == parent) return;
        auto best = straight_way(first, cell);
        if (second != first)
            if (auto other = straight_way(second, cell); other.end.time_s < best.end.time_s) best = other;
        double& known_s = time_s_[cell];
        if (!(best.end.time_s - known_s <= kHopeless * (known_s - best.start_s))) return;
        bend(best, cell, parent < 0 ? 0.0 : bend_[static_cast<std::size_t>(parent)]);
        const FireShape& shape = periods_.shapes(best.end.period)[cell];
        const double crossing_s = shape.time_s(best.ray.dx * grid_.cell_m, -best.ray.dy * grid_.cell_m) / best.ray.length();
        if (!(best.end.time_s <= known_s + kSlack * crossing_s)) return;
        const auto towards = best.ray.direction_at_end();
        if (best.end.time_s <= known_s + kSame_s)
            slowness_[cell] = slowness(shape, towards.col * grid_.cell_m, -towards.row * grid_.cell_m);
        known_s = std::min(known_s, best.end.time_s);
        bend_[cell] = static_cast<float>(best.ray.bend);
        origin_[cell] = best.origin;
        if (best.ray.length() <= (best.ray.bend == 0.0 ? kLongestStraight : kLongest)) return;
        const auto half = best.ray.first_half();
        const auto middle = best.ray.at(0.5);
        origins_.push_back({middle.col, middle.row, end_of(half, best.start_s).time_s});
        origin_[cell] = -static_cast<Place>(origins_.size());
    }
    [[nodiscard]] Place origin_of(Place at) const noexcept { return at < 0 ? at : origin_[static_cast<std::size_t>(at)]; }

    /// Bends a straight way to the earliest arrival: three bends around that of its parent, then the lowest point of a parabola in time
    /// through them. On even ground none is earlier.
    void bend(Way& best, std::size_t cell, double parents_bend) {
        constexpr double kLeastLength = 3.0, kEven = 1e-6, kStep = 0.1, kFarthest = 2.0;
        const double length = best.ray.length();
        const double even_s =
            periods_.shapes(best.end.period)[cell].time_s(best.ray.dx * grid_.cell_m, -best.ray.dy * grid_.cell_m);
        if (length < kLeastLength || std::abs(best.end.time_s - best.start_s - even_s) <= kEven * even_s) return;
        const auto earlier = [&](double bend) {
            const auto ray = CurvedRay{best.ray.start, best.ray.dx, best.ray.dy, bend};
            const auto end = end_of(ray, best.start_s);
            if (end.time_s < best.end.time_s) best.ray = ray, best.end = end;
            return end.time_s;
        };
        const double step = std::max(0.25 * std::abs(parents_bend), kStep / length);
        const double before = earlier(parents_bend - step), middle = earlier(parents_bend),
                     after = earlier(parents_bend + step);
        const double rise = before - 2.0 * middle + after;
        if (rise > 0.0 && rise < kNever)
            (void)earlier(parents_bend + step * std::clamp(0.5 * (before - after) / rise, -kFarthest, kFarthest));
    }

    /// Where and when a ray may begin: the centre of a cell, or a seed or the middle of a long way.
    [[nodiscard]] Seed place(Place at) const noexcept {
        if (at < 0) return origins_[static_cast<std::size_t>(-1 - at)];
        const int row = at / grid_.cols, col = at % grid_.cols;
        return {col + 0.5, row + 0.5, time_s_[static_cast<std::size_t>(at)]};
    }

    /// Straight rays to the cells around a seed.
    void light(std::size_t number) {
        constexpr int kRadius = 4;
        const Seed& seed = job_.seeds[number];
        const auto self = static_cast<Place>(-1 - static_cast<std::ptrdiff_t>(number));
        const int col = static_cast<int>(std::floor(seed.col)), row = static_cast<int>(std::floor(seed.row));
        for (int r = row - kRadius; r <= row + kRadius; ++r)
            for (int c = col - kRadius; c <= col + kRadius; ++c) {
                const double dx = c + 0.5 - seed.col, dy = r + 0.5 - seed.row;
                if (!grid_.contains(r, c) || std::hypot(dx, dy) > kRadius) continue;
                // A seed in the very centre has no direction; any will do.
                const double x_m = dx * grid_.cell_m, y_m = -dy * grid_.cell_m;
                offer(grid_.index(r, c), {self, self}, seed.time_s, x_m == 0.0 && y_m == 0.0 ? 1e-3 : x_m, y_m,
                      [&](const FireShapes& shapes) {
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
                offer(cell, {static_cast<Place>(from), static_cast<Place>(from)}, time_s_[from], x_m(o), y_m(o),
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

    /// The ray to a cell from the best point between two burnt neighbours.
    void reach_between(const Now& now, const Pair& pair) {
        const FireShape& shape = now.shapes[pair.cell];
        const Offset one = ring_[pair.direction].from, other = ring_[pair.side].from;
        const double x = x_m(one), y = y_m(one), dx = x_m(other) - x, dy = y_m(other) - y;
        const double start = time_s_[pair.from], step = time_s_[pair.beside] - start;
        if (time_s_[pair.cell] <= std::min(start, start + step)) return;
        const double share = earliest_share(shape, x, y, dx, dy, step);
        if (!(share > 0.0 && share < 1.0)) return;
        const double ray_x = x + share * dx, ray_y = y + share * dy;
        const double between = start + share * step + bend_s(pair, -dx, -dy, step, share);
        const double last_piece = std::min(ring_[pair.direction].piece[0].share, ring_[pair.side].piece[0].share);
        if (!hopeful(now, pair.cell, between, last_piece, ray_x, ray_y)) return;
        Parents parents{static_cast<Place>(pair.from), static_cast<Place>(pair.beside)};
        if (share >= 0.5) std::swap(parents.nearer, parents.farther);
        offer(pair.cell, parents, between, ray_x, ray_y, [&](const FireShapes& then) {
            const FireShape& own = then[pair.cell];
            const double t = std::lerp(ray_s(then, pair.cell, pair.direction) / own.time_s(x, y),
                                       ray_s(then, pair.cell, pair.side) / own.time_s(x + dx, y + dy), share) *
                             own.time_s(ray_x, ray_y);
            return std::isnan(t) ? kNever : t;
        });
    }

    /// What a cubic through both times with both slownesses adds to the straight line between two cells, limited.
    [[nodiscard]] double bend_s(const Pair& pair, double x_m, double y_m, double step, double share) const noexcept {
        if (origin_[pair.from] == origin_[pair.beside]) return 0.0;  // the long way is looked at when the cell is taken
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
    std::vector<Seed> origins_;                    ///< of ways: the seeds, then middles of long ways
    std::vector<Place> parent_, beside_, origin_;  ///< whence the last ray to a cell came; where the long way to it begins
    std::vector<float> bend_;                      ///< of that way
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

Arrival propagate(const Propagation& job) {
    if (job.period_start_s.empty()) throw input_error("spread", "no weather is given");
    return Front(job).run();
}

}  // namespace pyroscene::spread
