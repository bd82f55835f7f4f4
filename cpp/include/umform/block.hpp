// A block: all elements of one kind, their history and their share of residual and tangent.
#pragma once

#include <limits>
#include <stdexcept>

#include "umform/csr.hpp"
#include "umform/solid_shell.hpp"
#include "umform/threads.hpp"

namespace umform {

/// Where a block adds its share. Arrays over all degrees of freedom, but `values` over the entries of the pattern.
struct Target {
    double* f;                   // internal forces
    double* values;              // tangent over the free degrees of freedom
    const double* du = nullptr;  // if given: increment of the prescribed degrees of freedom ...
    double* Kdu = nullptr;       // ... and K du
};

/// Outcome of `evaluate`: the first element whose strain left the domain of its law or whose
/// enhanced parameters cannot be eliminated (or -1), and sum |f_e|^2, the scale
/// of the forces that a residual is measured against.
struct Outcome {
    int failed = -1;
    double force_scale_squared = 0.0;
};

/// Fields at the Gauss points of all elements, for output. Arrays [element][point][...].
struct PointFields {
    double *E, *S;  // [6] in the local frame
    double* frame;  // [3][3]: rows e_1, e_2, e_3
    double* F;      // [3][3]: compatible deformation gradient in global axes
    double* dV;     // reference volume
};

/// Reads the nodal values of one element into its order by direction.
template <int Nodes>
void gather(const Connectivity& part, int element, const double* field, double* local) {
    const std::int32_t* ids = part[element];
    for (int a = 0; a < Nodes; ++a)
        for (int k = 0; k < 3; ++k) local[k * Nodes + a] = field[3 * ids[a] + k];
}

/// Adds K, f (and K du of prescribed increments) of one element; K holds its upper triangle.
template <int Nodes>
void scatter_element(const Connectivity& part, const Scatter& scatter, int element, double* K, const double* f,
                     const Target& target) {
    constexpr int size = 3 * Nodes;
    const std::int32_t* ids = part[element];
    for (int a = 0; a < Nodes; ++a)
        for (int k = 0; k < 3; ++k) target.f[3 * ids[a] + k] += f[k * Nodes + a];
    if (!scatter.symmetric || target.du != nullptr)
        for (int i = 0; i < size; ++i)
            for (int j = 0; j < i; ++j) K[i * size + j] = K[j * size + i];
    if (target.du != nullptr) {
        std::array<double, size> du;
        gather<Nodes>(part, element, target.du, du.data());
        for (int a = 0; a < Nodes; ++a)
            for (int k = 0; k < 3; ++k) {
                double sum = 0.0;
                for (int j = 0; j < size; ++j) sum += K[(k * Nodes + a) * size + j] * du[j];
                target.Kdu[3 * ids[a] + k] += sum;
            }
    }
    scatter.add(element, K, target.values);
}

/// The elements as Python sees them. `evaluate` is pure in the history: it reads the converged state and writes the
/// trial state and the condensed blocks; `recover`, `commit` and `revert` are explicit.
class ShellBlock {
  public:
    virtual ~ShellBlock() = default;
    virtual const Connectivity& connectivity() const = 0;
    virtual std::size_t dofs() const = 0;  // length of u and f
    virtual int points() const = 0;
    virtual int modes() const = 0;
    virtual int state_size() const = 0;
    virtual Outcome evaluate(const double* u, const Scatter& scatter, const Target& target) = 0;
    virtual void fields(const double* u, const PointFields& fields) = 0;
    /// Energies over the whole block with the converged history and parameters, which belong to u; the trial history stays
    /// as it is. NaN where the law does not know them. eq. (5.30)
    virtual Energy energy(const double* u) = 0;
    /// K, f of one element before its scatter, condensed; for tests and eigenvalues.
    virtual void element(int e, const double* u, double* K, double* f) = 0;

    /// alpha -= Kaa^-1 (ra + s Kad du) with the blocks of the last `evaluate`. eq. (2.19)
    virtual void recover(const double* du, double s) = 0;
    /// Takes the last `recover` back.
    void undo_recover() { alpha_ = alpha_before_; }

    void commit() {
        state_.swap(trial_);
        trial_ = state_;
        alpha_converged_ = alpha_;
    }
    void revert() { alpha_ = alpha_before_ = alpha_converged_; }

    const std::vector<double>& state() const { return state_; }
    /// For each point, whether the last `evaluate` has changed its history: 1 where the material flows.
    std::vector<std::uint8_t> flowing() const {
        const std::size_t size = state_size(), count = size > 0 ? state_.size() / size : 0;
        std::vector<std::uint8_t> flows(count);
        for (std::size_t q = 0; q < count; ++q)
            flows[q] = !std::equal(state_.begin() + q * size, state_.begin() + (q + 1) * size, trial_.begin() + q * size);
        return flows;
    }
    const std::vector<double>& alpha() const { return alpha_converged_; }
    void restore(const double* state, const double* alpha) {
        state_.assign(state, state + state_.size());
        alpha_converged_.assign(alpha, alpha + alpha_converged_.size());
        revert();
    }

  protected:
    std::vector<double> state_, trial_;                           // [element][point][state_size]
    std::vector<double> alpha_, alpha_before_, alpha_converged_;  // [element][mode]
};

template <int Nodes>
class ShellBlockOf final : public ShellBlock {
  public:
    using Element = SolidShell<Nodes>;
    static constexpr int size = Element::size;

    ShellBlockOf(const Technology& technology, int surface_points, const Rule& thickness,
                 std::shared_ptr<const Material> material, Connectivity part, std::vector<double> X)
        : element_(technology, surface_points, thickness), material_(std::move(material)), part_(std::move(part)),
          X_(std::move(X)), colours_(make_colours(part_)) {
        const std::size_t elements = part_.size(), modes = element_.modes();
        const int state_size = material_->state_size();
        state_.resize(elements * element_.points() * state_size);
        if (state_size > 0)
            for (double* s = state_.data(); s != state_.data() + state_.size(); s += state_size) material_->initial(s);
        trial_ = state_;
        alpha_.assign(elements * modes, 0.0);
        alpha_before_ = alpha_converged_ = alpha_;
        y_.resize(elements * modes);
        Y_.resize(elements * modes * size);
        scale_.resize(elements);
        failed_.resize(elements);
        energy_.resize(elements);
    }

    const Connectivity& connectivity() const override { return part_; }
    std::size_t dofs() const override { return X_.size(); }
    int points() const override { return element_.points(); }
    int modes() const override { return element_.modes(); }
    int state_size() const override { return material_->state_size(); }

    Outcome evaluate(const double* u, const Scatter& scatter, const Target& target) override {
        prepare_workspaces();
        for_each_by_colour(colours_, part_.size(), [&](int e, int thread) {
            Workspace& w = workspaces_[thread];
            failed_[e] = compute(e, u, w, trial_of(e)) ? 0 : 1;
            if (failed_[e] != 0) return;
            double sum = 0.0;
            for (const double value : w.f) sum += value * value;
            scale_[e] = sum;
            const std::size_t modes = element_.modes();
            std::copy(w.ra.begin(), w.ra.end(), y_.begin() + e * modes);
            std::copy(w.Kad.begin(), w.Kad.end(), Y_.begin() + e * modes * size);
            scatter_element<Nodes>(part_, scatter, e, w.K.data(), w.f.data(), target);
        });
        Outcome outcome;
        for (int e = 0; e < part_.size(); ++e) {
            if (failed_[e] != 0 && outcome.failed < 0) outcome.failed = e;
            outcome.force_scale_squared += scale_[e];
        }
        return outcome;
    }

    void recover(const double* du, double s) override {
        alpha_before_ = alpha_;
        const int modes = element_.modes();
        if (modes == 0) return;
        std::array<double, size> local;
        for (int e = 0; e < part_.size(); ++e) {
            gather<Nodes>(part_, e, du, local.data());
            for (int m = 0; m < modes; ++m) {
                const std::size_t row = static_cast<std::size_t>(e) * modes + m;
                double sum = 0.0;
                for (int i = 0; i < size; ++i) sum += Y_[row * size + i] * local[i];
                alpha_[row] -= y_[row] + s * sum;
            }
        }
    }

    void element(int e, const double* u, double* K, double* f) override {
        prepare_workspaces();
        Workspace& w = workspaces_[0];
        std::vector<double> scratch(static_cast<std::size_t>(points()) * material_->state_size());
        if (!compute(e, u, w, scratch.data()))
            throw std::domain_error("the element is outside of the domain of its law, or Kaa is singular");
        for (int a = 0; a < Nodes; ++a)
            for (int k = 0; k < 3; ++k) {
                const int i = k * Nodes + a;
                f[3 * a + k] = w.f[i];
                for (int b = 0; b < Nodes; ++b)
                    for (int l = 0; l < 3; ++l) {
                        const int j = l * Nodes + b;
                        K[(3 * a + k) * size + 3 * b + l] = w.K[std::min(i, j) * size + std::max(i, j)];
                    }
            }
    }

    void fields(const double* u, const PointFields& out) override {
        prepare_workspaces();
        Workspace& w = workspaces_[0];
        typename Element::Nodal X, local_u;
        std::vector<double> scratch(static_cast<std::size_t>(points())
                                    * material_->state_size());  // trial stays as it is
        for (int e = 0; e < part_.size(); ++e) {
            gather<Nodes>(part_, e, X_.data(), X.data());
            gather<Nodes>(part_, e, u, local_u.data());
            const double* alpha = alpha_.data() + static_cast<std::size_t>(e) * element_.modes();
            if (!element_.strains(X, local_u, alpha, w) || !respond(e, w, scratch.data()))
                throw std::domain_error("an element is outside of the domain of its law");
            for (int q = 0; q < points(); ++q) {
                const std::size_t at = static_cast<std::size_t>(e) * points() + q;
                std::copy(w.E[q].begin(), w.E[q].end(), out.E + 6 * at);
                std::copy(w.S[q].begin(), w.S[q].end(), out.S + 6 * at);
                const Mat3 J = Element::jacobian(element_.gradient(q), X), Jinv = inverse(J);
                const auto frame = local_frame(
                    {Vec3{J(0, 0), J(1, 0), J(2, 0)}, {J(0, 1), J(1, 1), J(2, 1)}, {J(0, 2), J(1, 2), J(2, 2)}});
                for (int i = 0; i < 3; ++i)
                    for (int k = 0; k < 3; ++k) {
                        out.frame[9 * at + 3 * i + k] = frame[i][k];
                        double F = 0.0;
                        for (int m = 0; m < 3; ++m) F += w.g[q][m][i] * Jinv(m, k);
                        out.F[9 * at + 3 * i + k] = F;
                    }
                out.dV[at] = w.dV[q];
            }
        }
    }

    Energy energy(const double* u) override {
        prepare_workspaces();
        for_each_by_colour(colours_, part_.size(), [&](int e, int thread) {
            Workspace& w = workspaces_[thread];
            energy_[e] = Energy{};
            if (!strains(e, u, alpha_converged_.data(), w)) return;
            material_->energy(points(), w.E.data(), state_.data() + first_state(e), w.energy.data());
            energy_[e] = {0.0, 0.0};
            for (int q = 0; q < points(); ++q) {
                energy_[e].elastic += w.energy[q].elastic * w.dV[q];
                energy_[e].plastic += w.energy[q].plastic * w.dV[q];
            }
        });
        Energy total{0.0, 0.0};  // in the order of the elements, whatever the number of threads
        for (const Energy& one : energy_) {
            total.elastic += one.elastic;
            total.plastic += one.plastic;
        }
        return total;
    }

  private:
    using Workspace = typename Element::Workspace;

    void prepare_workspaces() {
        while (static_cast<int>(workspaces_.size()) < thread_count()) workspaces_.push_back(element_.workspace());
    }

    /// Asks the material at the points of an element; `trial` takes the new history.
    bool respond(int e, Workspace& w, double* trial) {
        const int q = points();
        return material_->respond(q, w.E.data(), state_.data() + first_state(e), w.S.data(), w.CC.data(), trial) == q;
    }

    /// Where the history of an element begins in `state_` and `trial_`.
    std::size_t first_state(int e) const { return static_cast<std::size_t>(e) * points() * material_->state_size(); }
    double* trial_of(int e) { return trial_.data() + first_state(e); }

    /// Strains of an element at u with the enhanced parameters `alpha` of all elements. False if it is inverted.
    bool strains(int e, const double* u, const double* alpha, Workspace& w) const {
        typename Element::Nodal X, local_u;
        gather<Nodes>(part_, e, X_.data(), X.data());
        gather<Nodes>(part_, e, u, local_u.data());
        return element_.strains(X, local_u, alpha + static_cast<std::size_t>(e) * element_.modes(), w);
    }

    bool compute(int e, const double* u, Workspace& w, double* trial) {
        if (!strains(e, u, alpha_.data(), w)) return false;
        if (!respond(e, w, trial)) return false;
        element_.integrate(w);
        return element_.condense(w);
    }

    Element element_;
    std::shared_ptr<const Material> material_;
    Connectivity part_;
    std::vector<double> X_;
    std::vector<std::vector<std::int32_t>> colours_;
    std::vector<Workspace> workspaces_;  // one a thread
    std::vector<double> y_, Y_;          // Kaa^-1 ra, Kaa^-1 Kad of the last evaluate
    std::vector<double> scale_;
    std::vector<char> failed_;
    std::vector<Energy> energy_;
};

// Instantiated in cpp/src, one file each, so that they compile in parallel.
extern template class ShellBlockOf<8>;
extern template class ShellBlockOf<18>;

}  // namespace umform
