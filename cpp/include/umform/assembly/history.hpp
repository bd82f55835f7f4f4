// The history of a term: what the points of its elements or facets remember from one increment to the next.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "umform/assembly/history_variables.hpp"

namespace umform {

/// Numbers [item][point][size] of the converged state, and those of the trial state that an evaluation writes. An item is an
/// element or a facet. `evaluate` reads the converged state only; the trial state takes its place in `commit`.
class History {
  public:
    History() = default;
    History(int items, int points, std::vector<HistoryVariable> history_variables)
        : items_(items), points_(points), quantities_(std::move(history_variables)) {
        for (const HistoryVariable& quantity : quantities_) size_ += quantity.size;
        state_.assign(stride() * items, 0.0);
        trial_ = state_;
    }

    int items() const { return items_; }
    int points() const { return points_; }
    /// Numbers of one point.
    int size() const { return size_; }
    /// Numbers of one item.
    std::size_t stride() const { return static_cast<std::size_t>(points_) * size_; }
    const std::vector<HistoryVariable>& history_variables() const { return quantities_; }

    const std::vector<double>& state() const { return state_; }
    const double* state(int item) const { return state_.data() + item * stride(); }
    double* trial(int item) { return trial_.data() + item * stride(); }
    const double* trial(int item) const { return trial_.data() + item * stride(); }

    const std::vector<double>& trial() const { return trial_; }
    /// Trial numbers of a point, counted over all items.
    double* point(int q) { return trial_.data() + static_cast<std::size_t>(q) * size_; }
    const double* point(int q) const { return trial_.data() + static_cast<std::size_t>(q) * size_; }

    /// Calls begin(numbers of a point) for all points, and makes that the converged and the trial state.
    template <class Begin>
    void initialise(const Begin& begin) {
        if (size_ > 0)
            for (std::size_t at = 0; at < state_.size(); at += size_) begin(state_.data() + at);
        revert();
    }

    /// For each point, whether its trial state differs from the converged one; empty without a history.
    std::vector<std::uint8_t> changed() const {
        std::vector<std::uint8_t> answer(size_ > 0 ? state_.size() / size_ : 0);
        for (std::size_t q = 0; q < answer.size(); ++q) {
            const auto first = state_.begin() + static_cast<std::ptrdiff_t>(q) * size_;
            answer[q] = !std::equal(first, first + size_, trial_.begin() + static_cast<std::ptrdiff_t>(q) * size_);
        }
        return answer;
    }

    void commit() { state_ = trial_; }
    void revert() { trial_ = state_; }
    /// Takes a converged state, in the order of `state`, as its own; `count` numbers.
    void restore(const double* state, std::size_t count) {
        if (count != state_.size()) throw std::invalid_argument("a stored history has another size than the model");
        state_.assign(state, state + count);
        revert();
    }

  private:
    int items_ = 0, points_ = 0, size_ = 0;
    std::vector<HistoryVariable> quantities_;
    std::vector<double> state_, trial_;
};

}  // namespace umform
