// A block of solid-shells as Python sees it, for any number of nodes: history, enhanced parameters, evaluation.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "umform/assembly/history.hpp"
#include "umform/assembly/target.hpp"
#include "umform/materials/concept.hpp"

namespace umform {

/// Fields at the Gauss points of all elements, for output. Arrays [element][point][...].
struct PointFields {
    double *E, *S;  // [6] in the local frame
    double* frame;  // [3][3]: rows e_1, e_2, e_3
    double* F;      // [3][3]: compatible deformation gradient in global axes
    double* dV;     // reference volume
};

/// Fields of all elements, for output: means over the reference volume, and largest values of all Gauss points. Arrays
/// [element][...].
struct CellFields {
    std::array<double*, 4> stresses;  // [6] Cauchy stress in global and in local axes, S in global and in local axes
    double* von_mises;                // largest
    double *mean = nullptr, *largest = nullptr;  // of a scalar of the history, if requested
    int scalar = -1;                             // its place in the history of a point
};

/// The elements as Python sees them. `evaluate` is pure in the history: it reads the converged state and writes the
/// trial state and, with a tangent, the condensed blocks; `recover`, `commit` and `revert` are explicit.
class ShellBlock {
  public:
    virtual ~ShellBlock() = default;
    virtual const Connectivity& connectivity() const = 0;
    virtual std::size_t dofs() const = 0;  // length of u and f
    virtual int points() const = 0;
    virtual int modes() const = 0;
    virtual int state_size() const = 0;
    virtual bool symmetric() const = 0;  // whether the tangent is
    virtual Outcome evaluate(const double* u, const Scatter& scatter, const Target& target) = 0;
    virtual void fields(const double* u, const PointFields& fields) = 0;
    virtual void fields(const double* u, const CellFields& fields) = 0;
    /// Energies over the whole block with the converged history and parameters, which belong to u; the trial history stays
    /// as it is. NaN where the law does not know them. eq. (5.30)
    virtual Energy energy(const double* u) = 0;
    /// K, f of one element before its scatter, condensed; for tests and eigenvalues.
    virtual void element(int e, const double* u, double* K, double* f) = 0;
    /// The first point of an element at which its law has no answer, and the strain there; -1 if it has one everywhere.
    virtual std::pair<int, Voigt> failing_point(int e, const double* u) = 0;

    /// alpha -= Kaa^-1 (ra + Kad du) with the blocks of the last `evaluate` with a tangent, or with those of the converged state
    /// if there was none since `commit` or `revert`. eq. (2.19) If `mixed`, the evaluations that follow take the geometric stiffness from the stress that the
    /// correction du foresaw. eq. (5.39)
    void recover(const double* du, bool mixed) {
        alpha_before_ = alpha_;
        correction_.resize(mixed ? dofs() : 0);
        for (std::size_t i = 0; i < correction_.size(); ++i) correction_[i] = du[i];
        if (modes() > 0) recover_enhanced(du);
    }
    /// alpha += change, in place of `recover`: the change is known from a similar run.
    void recover_by(const double* change) {
        alpha_before_ = alpha_;
        correction_.clear();
        for (std::size_t i = 0; i < alpha_.size(); ++i) alpha_[i] += change[i];
    }
    /// Takes the blocks of the last tangent of the same elements in a similar run, for an `evaluate` of forces alone.
    virtual void take_blocks(const ShellBlock& of) = 0;
    /// After an `evaluate` of forces alone: the next `recover` takes its residual, with the previous tangent.
    virtual void follow() = 0;
    /// Shortens what the last `recover` has changed to a part of it. eq. (5.12)
    void shorten(double part) {
        for (std::size_t i = 0; i < alpha_.size(); ++i)
            alpha_[i] = alpha_before_[i] + part * (alpha_[i] - alpha_before_[i]);
        for (double& c : correction_) c *= part;
    }

    void commit() {
        history_.commit();
        alpha_converged_ = alpha_;
        correction_.clear();
        keep_blocks();
    }
    void revert() {
        history_.revert();
        alpha_ = alpha_before_ = alpha_converged_;
        correction_.clear();
        return_to_kept_blocks();
    }
    /// Whether the blocks of the converged state exist: not before the first `commit`, and not after `restore`.
    virtual bool keeps_blocks() const = 0;
    /// Largest change of an enhanced parameter that a recovery without a displacement makes after the last `evaluate`: zero where they
    /// are in equilibrium. eq. (2.19)
    double enhanced_change() const { return enhanced_change_; }
    /// Points at which return maps have gone through stages of a shrinking yield surface, over all evaluations.
    virtual std::uint64_t staged_returns() const = 0;

    const std::vector<double>& state() const { return history_.state(); }
    /// The parts of the history of a point, in their order.
    const std::vector<HistoryVariable>& history_variables() const { return history_.history_variables(); }
    /// For each point, whether the last `evaluate` has changed its history: 1 where the material flows.
    std::vector<std::uint8_t> flowing() const { return history_.changed(); }
    const std::vector<double>& alpha() const { return alpha_converged_; }
    void restore(const double* state, const double* alpha) {
        history_.restore(state, history_.state().size());
        alpha_converged_.assign(alpha, alpha + alpha_converged_.size());
        forget_blocks();
        revert();
    }

    /// Numbers of the elements for messages, where they are a part of a larger mesh.
    void set_numbers(std::vector<std::int32_t> numbers) { numbers_ = std::move(numbers); }

    double step = 0.0;  // time increment, for laws that need it

  protected:
    double enhanced_change_ = 0.0;
    std::int32_t number_of(int e) const { return numbers_.empty() ? e : numbers_[e]; }
    virtual void recover_enhanced(const double* du) = 0;
    virtual void keep_blocks() = 0;
    virtual void return_to_kept_blocks() = 0;
    virtual void forget_blocks() = 0;

    std::vector<std::int32_t> numbers_;
    std::vector<double> correction_;                              // of all degrees of freedom, or empty
    History history_;                                             // [element][point][state_size]
    std::vector<double> alpha_, alpha_before_, alpha_converged_;  // [element][mode]
};

}  // namespace umform
