// Multifrontal factorisation: fronts are assembled, eliminated, and what is left of them goes into the front of the parent.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "umform/multifrontal/cholesky.hpp"
#include "umform/multifrontal/equilibration.hpp"
#include "umform/multifrontal/indefinite.hpp"
#include "umform/multifrontal/panels.hpp"
#include "umform/multifrontal/plan.hpp"
#include "umform/multifrontal/schedule.hpp"
#include "umform/multifrontal/storage.hpp"
#include "umform/multifrontal/unsymmetric.hpp"

namespace umform::multifrontal {

enum class Kind : std::uint8_t { Positive, Symmetric, Unsymmetric };

/// How a factorisation has ended.
struct Outcome {
    enum State : std::uint8_t { Done, NotPositive, Singular } state = Done;
    int equation = -1;  // of the pivot that has ended it
};

/// What a front has become. Rows and columns that could not be eliminated here, since no pivot among them was stable, are
/// eliminated in the front of the parent: they follow its own pivots.
struct Eliminated {
    int pivots = 0, size = 0, done = 0;       // with those that the children have left; of them eliminated
    DenseColumns a;                           // of the factor; rows of the other one follow
    Block own;                                // where they are longer than planned
    DenseColumns update;                      // for the parent: rows that are left, then those of ancestors
    Room room;                                // of the update, unless it is in the stacks of its subtree
    std::vector<std::int32_t> rows, columns;  // places of the pivots in their order of elimination; empty if as planned
    std::vector<double> below;                // entries beside the diagonal of pivots of two columns

    int left() const { return pivots - done; }
    int order() const { return size - done; }
    double* b() const { return a.data + a.panels.size(); }
};

/// Numeric factors of matrices with one pattern.
class Factors {
  public:
    explicit Factors(const Plan& plan) : plan_(plan), schedule_(plan), fronts_(plan.fronts.size()) {}

    Outcome factor(Kind kind, const double* values, Scaling scaling, int threads) {
        kind_ = kind, values_ = values, scaling_ = std::move(scaling), state_ = Outcome::Done, equation_ = -1;
        const OneBlasThread alone;
        const std::optional<Buffers> buffers = reserve(threads);
        schedule_.run(
            plan_, team_,
            [&](const Schedule::Unit& unit, int thread) {
                Worker& worker = workers_[thread];
                Room room = Room::of(arena_, pool_, schedule_.stacks, !schedule_.side(unit.root), 0);
                worker.stacks.use(room.data, schedule_.stacks);
                for (int f = unit.begin; f <= unit.root; ++f) process(f, worker, f < unit.root);
                room.release(arena_, pool_);
            },
            [&](int f, int thread) { process(f, workers_[thread], false); });
        return {state_.load(), equation_};
    }

    const Plan& plan() const { return plan_; }
    Kind kind() const { return kind_; }
    const Scaling& scaling() const { return scaling_; }
    const Schedule& schedule() const { return schedule_; }
    const Eliminated& front(int f) const { return fronts_[f]; }
    /// Memory for so many numbers: that of updates, which are gone after a factorisation.
    Lent lend(std::size_t size) const {
        return {lent_, storage_.data() + schedule_.floor, schedule_.end - schedule_.floor, size};
    }

    /// Place of the row and of the column of a pivot of a front.
    int row(int f, int k) const { return fronts_[f].rows.empty() ? plan_.fronts[f].first + k : fronts_[f].rows[k]; }
    int column(int f, int k) const {
        return fronts_[f].columns.empty() ? plan_.fronts[f].first + k : fronts_[f].columns[k];
    }

  private:
    /// Rows of an update that follow each other in the front of the parent too.
    struct Run {
        int from, to, length;
    };
    struct Child {
        const Eliminated* front;
        const std::int32_t* seat;
        int order, split;  // columns before `split` are pivots of the parent
        bool sorted;
        std::vector<std::int32_t> own_seat;
        std::vector<Run> runs;
    };
    struct Worker {
        Stacks stacks;
        std::vector<Child> seats;         // grows only
        std::span<Child> children;        // of the present front
        std::vector<double> row, column;  // scales of its rows and columns
    };

    const Plan& plan_;
    Schedule schedule_;
    std::vector<Eliminated> fronts_;
    std::vector<Worker> workers_;
    Block storage_;  // the factors as planned, and behind them the arena
    Arena arena_;    // of updates as planned
    Pool pool_;      // of those that find no room there
    mutable std::atomic_flag lent_;
    Kind kind_ = Kind::Positive;
    const double* values_ = nullptr;
    Scaling scaling_;
    std::atomic<Outcome::State> state_{Outcome::Done};
    int equation_ = -1;
    int team_ = 1;  // threads of the present factorisation

    static constexpr int kLarge = 256;  // rows of an update that is shared among threads

    /// Takes all memory that is planned, or throws: before any product is made, since BLAS may not come back where none is left.
    std::optional<Buffers> reserve(int threads) {
        team_ = schedule_.factoring(threads);
        storage_.grow(schedule_.end);
        arena_.reset(storage_.data() + schedule_.begin, schedule_.end - schedule_.begin);
        if (static_cast<int>(workers_.size()) < threads) workers_ = std::vector<Worker>(threads);
        if (team_ == 1 && !schedule_.is_large()) return {};
        const std::size_t more = team_ == 1 ? 0 : schedule_.peak, above = more > pool_.held() ? more - pool_.held() : 0;
        return std::optional<Buffers>(std::in_place, team_, above);
    }

    void process(int f, Worker& worker, bool stack) {
        if (state_.load(std::memory_order_relaxed) != Outcome::Done) return;
        Eliminated& front = fronts_[f];
        open(f, front, worker);
        add_entries(f, front);
        if (scaling_.active()) scale(f, front, worker);
        for (const Child& child : worker.children) add_pivots(child, front);
        if (!eliminate(f, front)) return;
        if (front.order() > 0) make_update(f, front, worker, stack);
        for (int k = plan_.children_start[f]; k < plan_.children_start[f + 1]; ++k) release(plan_.children[k], worker);
    }

    void stop(Outcome::State state, int place) {
        Outcome::State done = Outcome::Done;
        if (state_.compare_exchange_strong(done, state)) equation_ = place < 0 ? -1 : plan_.equation[place];
    }

    /// Memory of a front, and the seats of its children in it.
    void open(int f, Eliminated& front, Worker& worker) {
        const Front& planned = plan_.fronts[f];
        const int begin = plan_.children_start[f], count = plan_.children_start[f + 1] - begin;
        if (static_cast<int>(worker.seats.size()) < count) worker.seats.resize(count);
        worker.children = {worker.seats.data(), static_cast<std::size_t>(count)};
        int delayed = 0;
        for (int k = 0; k < count; ++k) delayed += fronts_[plan_.children[begin + k]].left();
        front.pivots = planned.pivots + delayed, front.size = planned.size + delayed;
        front.rows.clear(), front.columns.clear();
        const std::size_t p = front.pivots, m = front.size;
        front.a.panels = Panels::of_factor(m, p, kind_ != Kind::Unsymmetric);
        const std::size_t all = front.a.panels.size() + (kind_ == Kind::Unsymmetric ? p * (m - p) : 0);
        if (delayed == 0) {
            front.own = Block();
            front.a.data = storage_.data() + planned.factor;
        } else {
            front.own.grow(all);
            front.a.data = front.own.data();
        }
        if (kind_ == Kind::Unsymmetric)
            std::fill_n(front.a.data, all, 0.0);
        else
            for (std::size_t j = 0; j < p; ++j) std::fill_n(front.a.at(j, j), m - j, 0.0);
        int next = planned.pivots;
        for (int k = 0; k < count; ++k) {
            const int c = plan_.children[begin + k];
            seat(fronts_[c], plan_.fronts[c], planned.pivots, delayed, next, worker.children[k]);
            next += fronts_[c].left();
        }
        if (kind_ != Kind::Positive) {
            for (int k = 0; k < planned.pivots; ++k) front.rows.push_back(planned.first + k);
            front.columns = front.rows;
            for (int k = 0; k < count; ++k) {
                const Eliminated& child = fronts_[plan_.children[begin + k]];
                if (child.left() == 0) continue;
                front.rows.insert(front.rows.end(), child.rows.begin() + child.done, child.rows.end());
                front.columns.insert(front.columns.end(), child.columns.begin() + child.done, child.columns.end());
            }
        }
    }

    /// Where the rows of an update go: those that a child has left behind the pivots that were planned.
    void seat(const Eliminated& child, const Front& planned, int pivots, int delayed, int next, Child& out) {
        out.front = &child, out.order = child.order();
        const std::int32_t* seats = plan_.seat.data() + planned.rows;
        out.sorted = delayed == 0;
        if (delayed == 0) {
            out.seat = seats;
        } else {
            out.own_seat.clear();
            for (int k = 0; k < child.left(); ++k) out.own_seat.push_back(next + k);
            for (int k = 0; k < planned.updates(); ++k)
                out.own_seat.push_back(seats[k] < pivots ? seats[k] : seats[k] + delayed);
            out.seat = out.own_seat.data();
        }
        const int all = pivots + delayed;
        out.split = static_cast<int>(std::lower_bound(out.seat, out.seat + out.order, all) - out.seat);
        if (!out.sorted) out.split = out.order;
        out.runs.clear();
        for (int k = 0; k < out.order; ++k) {
            if (k > 0 && out.seat[k] == out.seat[k - 1] + 1 && k != out.split)
                ++out.runs.back().length;
            else
                out.runs.push_back({k, out.seat[k], 1});
        }
    }

    void add_entries(int f, Eliminated& front) {
        const Front& planned = plan_.fronts[f];
        const int delayed = front.pivots - planned.pivots, p = planned.pivots, m = planned.size;
        if (delayed == 0 && !front.a.panels.parted()) {
            plan_.entries.for_each(f, m, p, [&](int source, int target) { front.a.data[target] += values_[source]; });
            return;
        }
        plan_.entries.for_each(f, m, p, [&](int source, int target) {
            if (target < p * m) {
                const int row = target % m, column = target / m;
                *front.a.at(row < p ? row : row + delayed, column) += values_[source];
            } else {
                front.b()[target - p * m] += values_[source];
            }
        });
    }

    /// Scales the entries of the matrix, before anything else is added to them.
    void scale(int f, Eliminated& front, Worker& worker) {
        const Front& planned = plan_.fronts[f];
        const int p = planned.pivots, m = front.size, beyond = m - front.pivots;
        std::vector<double>&r = worker.row, &c = worker.column;
        r.assign(m, 1.0), c.assign(m, 1.0);  // of what children have left there is nothing yet
        for (int k = 0; k < planned.size; ++k) {
            const int at = k < p ? k : k + front.pivots - p;
            const int i = plan_.equation[k < p ? planned.first + k : plan_.rows[planned.rows + k - p]];
            r[at] = scaling_.row[i], c[at] = scaling_.column[i];
        }
        for (int j = 0; j < p; ++j) {
            double* column = front.a.column(j);
            for (int i = kind_ == Kind::Unsymmetric ? 0 : j; i < m; ++i) column[i] *= r[i] * c[j];
            if (kind_ != Kind::Unsymmetric) continue;
            double* row = front.b() + static_cast<std::ptrdiff_t>(j) * beyond;
            for (int i = 0; i < beyond; ++i) row[i] *= r[j] * c[front.pivots + i];
        }
    }

    /// Adds the columns of an update that are pivots of the front, and rows that are.
    void add_pivots(const Child& child, Eliminated& front) {
        if (!child.sorted) return add_unsorted(child, front, true);
        for (int j = 0; j < child.split; ++j) {
            const double* column = child.front->update.column(j);
            double* to = front.a.column(child.seat[j]);
            add_column(child, column, to, kind_ == Kind::Unsymmetric ? 0 : j);
        }
        if (kind_ != Kind::Unsymmetric) return;
        const int beyond = front.size - front.pivots;
        for (int j = child.split; j < child.order; ++j) {
            const double* column = child.front->update.column(j);
            double* to = front.b() + child.seat[j] - front.pivots;
            for (int i = 0; i < child.split; ++i) to[static_cast<std::ptrdiff_t>(child.seat[i]) * beyond] += column[i];
        }
    }

    /// Adds rows of a column from `first` on.
    static void add_column(const Child& child, const double* column, double* to, int first) {
        for (const Run& run : child.runs) {
            const int skip = std::max(0, first - run.from);
            const double* x = column + run.from;
            double* y = to + run.to;
            for (int i = skip; i < run.length; ++i) y[i] += x[i];
        }
    }

    /// Adds an update with seats in any order: its part in the columns of the front, or that in its update.
    void add_unsorted(const Child& child, Eliminated& front, bool pivots) {
        const int p = front.pivots, shift = front.left() - p, beyond = front.size - p;
        for (int j = 0; j < child.order; ++j)
            for (int i = kind_ == Kind::Unsymmetric ? 0 : j; i < child.order; ++i) {
                const double value = *child.front->update.at(i, j);
                int row = child.seat[i], column = child.seat[j];
                if (kind_ != Kind::Unsymmetric && row < column) std::swap(row, column);
                if ((std::min(row, column) < p) != pivots) continue;
                if (!pivots)
                    *front.update.at(row + shift, column + shift) += value;
                else if (column < p)
                    *front.a.at(row, column) += value;
                else
                    front.b()[column - p + static_cast<std::ptrdiff_t>(row) * beyond] += value;
            }
    }

    bool eliminate(int f, Eliminated& front) {
        if (kind_ == Kind::Positive) {
            const int failed = cholesky(front.a, front.size, 0, front.pivots);
            front.done = front.pivots;
            if (failed >= 0) stop(Outcome::NotPositive, plan_.fronts[f].first + failed);
            return failed < 0;
        }
        int empty = -1;
        bool exchanged = front.pivots != plan_.fronts[f].pivots;
        if (kind_ == Kind::Symmetric) {
            Indefinite work(front.a, front.size, front.pivots, front.below, front.columns);
            front.done = work.run(empty);
            exchanged |= work.exchanged();
            front.rows = front.columns;
        } else {
            Unsymmetric work(front.a.data, front.b(), front.size, front.pivots, front.rows, front.columns);
            front.done = work.run(empty);
            exchanged |= work.exchanged();
        }
        const bool stuck = plan_.fronts[f].parent < 0 && front.left() > 0;
        if (empty >= 0 || stuck) {
            stop(Outcome::Singular, front.columns[empty >= 0 ? empty : front.done]);
            return false;
        }
        if (!exchanged && front.left() == 0) front.rows.clear(), front.columns.clear();
        return true;
    }

    /// What is left for the parent.
    void make_update(int f, Eliminated& front, Worker& worker, bool stack) {
        const int left = front.left();
        front.update.panels = Panels::of_update(front.order(), left, kind_ != Kind::Unsymmetric);
        const std::size_t size = front.update.panels.size();
        if (stack && left == 0 && front.pivots == plan_.fronts[f].pivots) {
            front.room = Room();
            front.update.data = worker.stacks.push(schedule_.depth[f], size);
        } else {
            const bool into_last = plan_.fronts[f].parent == schedule_.last;
            const std::size_t floor = into_last ? schedule_.floor - schedule_.begin : 0;
            front.room = Room::of(arena_, pool_, size, schedule_.side(f), floor);
            front.update.data = front.room.data;
        }
        if (left > 0) copy_left(front);
        const int beyond = front.size - front.pivots, width = block_of(front), blocks = (beyond + width - 1) / width;
        const std::span<const Child> children = worker.children;
        for_each(blocks, beyond >= kLarge ? team_ : 1, 1, [&](int k, int) {
            const int first = k * width, last = std::min(beyond, first + width);
            multiply(front, first, last);
            for (const Child& child : children)
                if (child.sorted) add_beyond(child, front, first, last);
        });
        for (const Child& child : children)
            if (!child.sorted) add_unsorted(child, front, false);
    }

    /// Columns of an update that are worked on at a time.
    static int block_of(const Eliminated& front) {
        const std::size_t width = front.update.panels.width();
        return width == 0 ? 192 : static_cast<int>(width);
    }

    /// Rows and columns that could not be eliminated.
    void copy_left(Eliminated& front) {
        const int order = front.order(), left = front.left(), beyond = order - left;
        for (int j = 0; j < left; ++j) {
            const int first = kind_ == Kind::Unsymmetric ? 0 : j;
            std::copy_n(front.a.at(front.done + first, front.done + j), order - first, front.update.at(first, j));
            if (kind_ != Kind::Unsymmetric) continue;
            const double* row = front.b() + static_cast<std::ptrdiff_t>(front.done + j) * beyond;
            for (int i = 0; i < beyond; ++i) *front.update.at(j, left + i) = row[i];
        }
    }

    /// Columns of the update: - L21 L21^T, - L21 D L21^T or - L21 U12.
    void multiply(Eliminated& front, int first, int last) {
        const int p = front.pivots, m = front.size, left = front.left(), q = front.done;
        const int width = last - first, stride = front.update.stride(left + first);
        double* c = front.update.at(left, left + first);
        if (kind_ == Kind::Unsymmetric) {
            const double* a = front.a.data + p;
            blas().gemm('N', 'T', m - p, width, q, -1.0, a, m, front.b() + first, m - p, 0.0, c, stride);
            return;
        }
        std::vector<std::int32_t> none;
        std::vector<double> scaled;
        if (kind_ == Kind::Symmetric)
            Indefinite(front.a, m, p, front.below, none).scale_rows(0, q, p + first, width, scaled);
        for (int k = 0, next = 0; k == 0 || k < q; k = next) {
            next = k + std::max(1, front.a.together(k, q - k));
            const double* a = front.a.at(p + first, k);
            const int ld = front.a.stride(k);
            const bool positive = kind_ == Kind::Positive;
            blas().gemm('N', 'T', m - p - first, width, std::min(next, q) - k, -1.0, a, ld,
                        positive ? a : scaled.data() + static_cast<std::size_t>(k) * width, positive ? ld : width,
                        k == 0 ? 0.0 : 1.0, c + first, stride);
        }
    }

    /// Adds columns of the update of a child to those of the front.
    void add_beyond(const Child& child, Eliminated& front, int first, int last) {
        const int shift = front.left() - front.pivots;
        const auto* end = child.seat + child.order;
        int j = static_cast<int>(std::lower_bound(child.seat + child.split, end, front.pivots + first) - child.seat);
        for (; j < child.order && child.seat[j] < front.pivots + last; ++j) {
            const double* column = child.front->update.column(j);
            double* to = front.update.at(shift, child.seat[j] + shift);
            add_column(child, column, to, kind_ == Kind::Unsymmetric ? child.split : j);
        }
    }

    void release(int f, Worker& worker) {
        Eliminated& front = fronts_[f];
        if (front.order() == 0) return;
        if (front.room.data == nullptr)
            worker.stacks.pop(schedule_.depth[f], front.update.panels.size());
        else
            front.room.release(arena_, pool_);
        front.update.data = nullptr;
    }
};

}  // namespace umform::multifrontal
