// A block: all elements of one kind, their history and their share of residual and tangent.
#pragma once

#include <limits>
#include <stdexcept>

#include "umform/assembly/batch.hpp"
#include "umform/assembly/colours.hpp"
#include "umform/assembly/history.hpp"
#include "umform/assembly/target.hpp"
#include "umform/assembly/threads.hpp"
#include "umform/elements/solid_shell.hpp"
#include "umform/materials/concept.hpp"

namespace umform {

/// Fields at the Gauss points of all elements, for output. Arrays [element][point][...].
struct PointFields {
    double *E, *S;  // [6] in the local frame
    double* frame;  // [3][3]: rows e_1, e_2, e_3
    double* F;      // [3][3]: compatible deformation gradient in global axes
    double* dV;     // reference volume
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
    virtual Outcome evaluate(const double* u, const Scatter& scatter, const Target& target) = 0;
    virtual void fields(const double* u, const PointFields& fields) = 0;
    /// Energies over the whole block with the converged history and parameters, which belong to u; the trial history stays
    /// as it is. NaN where the law does not know them. eq. (5.30)
    virtual Energy energy(const double* u) = 0;
    /// K, f of one element before its scatter, condensed; for tests and eigenvalues.
    virtual void element(int e, const double* u, double* K, double* f) = 0;

    /// alpha -= Kaa^-1 (ra + s Kad du) with the blocks of the last `evaluate` with a tangent; those without one leave the blocks
    /// as they are. eq. (2.19) If `mixed`, the evaluations that follow take the geometric stiffness from the stress that the
    /// correction s du foresaw. eq. (5.39)
    void recover(const double* du, double s, bool mixed) {
        alpha_before_ = alpha_;
        correction_.resize(mixed ? dofs() : 0);
        for (std::size_t i = 0; i < correction_.size(); ++i) correction_[i] = s * du[i];
        if (modes() > 0) recover_enhanced(du, s);
    }
    /// Takes the last `recover` back.
    void undo_recover() {
        alpha_ = alpha_before_;
        correction_.clear();
    }

    void commit() {
        history_.commit();
        alpha_converged_ = alpha_;
        correction_.clear();
    }
    void revert() {
        history_.revert();
        alpha_ = alpha_before_ = alpha_converged_;
        correction_.clear();
    }

    const std::vector<double>& state() const { return history_.state(); }
    /// For each point, whether the last `evaluate` has changed its history: 1 where the material flows.
    std::vector<std::uint8_t> flowing() const { return history_.changed(); }
    const std::vector<double>& alpha() const { return alpha_converged_; }
    void restore(const double* state, const double* alpha) {
        history_.restore(state, history_.state().size());
        alpha_converged_.assign(alpha, alpha + alpha_converged_.size());
        revert();
    }

  protected:
    virtual void recover_enhanced(const double* du, double s) = 0;

    std::vector<double> correction_;                              // of all degrees of freedom, or empty
    History history_;                                             // [element][point][state_size]
    std::vector<double> alpha_, alpha_before_, alpha_converged_;  // [element][mode]
};

template <int Nodes>
class ShellBlockOf final : public ShellBlock {
  public:
    using Element = SolidShell<Nodes, Lanes>;
    static constexpr int size = Element::size;

    ShellBlockOf(const Technology& technology, int surface_points, const Rule& thickness,
                 std::shared_ptr<const Material> material, Connectivity part, std::vector<double> X)
        : element_(technology, surface_points, thickness), material_(std::move(material)), part_(std::move(part)),
          X_(std::move(X)), batches_(make_colours(part_)) {
        const std::size_t elements = part_.size(), modes = element_.modes();
        history_ = History(part_.size(), element_.points(), {{"state", material_->state_size()}});
        history_.initialise([this](double* state) { material_->initial(state); });
        alpha_.assign(elements * modes, 0.0);
        alpha_before_ = alpha_converged_ = alpha_;
        y_.resize(batches_.all.size() * modes);
        Y_.resize(batches_.all.size() * modes * size);
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
        for_each_batch([&](int b, Workspace& w) {
            const Batch& batch = batches_.all[b];
            const LaneMask good = compute(batch, u, target.wants_tangent(), correction_, trial_of(batch), w);
            if (target.wants_tangent()) {
                const std::size_t modes = element_.modes();
                std::copy(w.shell.ra.begin(), w.shell.ra.end(), y_.begin() + b * modes);
                std::copy(w.shell.Kad.begin(), w.shell.Kad.end(), Y_.begin() + b * modes * size);
            }
            for (int lane = 0; lane < batch.count; ++lane) {
                const int e = batch.element[lane];
                failed_[e] = good[lane] ? 0 : 1;
                if (failed_[e] != 0) continue;
                const std::array<double, size>& f = w.results.f[lane];
                scale_[e] = dot(f, f);
                scatter_element<Nodes>(part_, scatter, e, w.results.K[lane].data(), f.data(), target);
            }
        });
        Outcome outcome;
        for (int e = 0; e < part_.size(); ++e) {
            if (failed_[e] != 0 && outcome.failed < 0) outcome.failed = e;
            outcome.force_scale_squared += scale_[e];
        }
        return outcome;
    }

    void recover_enhanced(const double* du, double s) override {
        const int modes = element_.modes();
        for_each_batch([&](int b, Workspace& w) {
            const Batch& batch = batches_.all[b];
            gather<Nodes>(part_, batch, du, w.u);
            for (int m = 0; m < modes; ++m) {
                const std::size_t row = static_cast<std::size_t>(b) * modes + m;
                Lanes sum = 0.0;
                for (int i = 0; i < size; ++i) sum += Y_[row * size + i] * w.u[i];
                const Lanes change = y_[row] + s * sum;
                for (int lane = 0; lane < batch.count; ++lane)
                    alpha_[static_cast<std::size_t>(batch.element[lane]) * modes + m] -= change[lane];
            }
        });
    }

    void element(int e, const double* u, double* K, double* f) override {
        prepare_workspaces(1);
        Workspace& w = workspaces_[0];
        const Batch batch = alone(e);
        std::vector<double> scratch(history_.stride());
        if (!compute(batch, u, true, {}, filled(scratch.data()), w)[0])
            throw std::domain_error("the element is outside of the domain of its law, or Kaa is singular");
        for (int a = 0; a < Nodes; ++a)
            for (int k = 0; k < 3; ++k) {
                const int i = k * Nodes + a;
                f[3 * a + k] = w.results.f[0][i];
                for (int b = 0; b < Nodes; ++b)
                    for (int l = 0; l < 3; ++l) {
                        const int j = l * Nodes + b;
                        K[(3 * a + k) * size + 3 * b + l] = w.results.K[0][std::min(i, j) * size + std::max(i, j)];
                    }
            }
    }

    void fields(const double* u, const PointFields& out) override {
        prepare_workspaces(1);
        Workspace& w = workspaces_[0];
        std::vector<double> scratch(history_.stride());  // trial stays as it is
        for (int e = 0; e < part_.size(); ++e) {
            const Batch batch = alone(e);
            if (!strains(batch, u, alpha_, w)[0] || !respond(batch, true, filled(scratch.data()), w)[0])
                throw std::domain_error("an element is outside of the domain of its law");
            for (int q = 0; q < points(); ++q) {
                const std::size_t at = static_cast<std::size_t>(e) * points() + q;
                for (int p = 0; p < 6; ++p) {
                    out.E[6 * at + p] = w.shell.E[q][p][0];
                    out.S[6 * at + p] = w.shell.S[q][p][0];
                }
                write_base(q, w, out.frame + 9 * at, out.F + 9 * at);
                out.dV[at] = w.shell.dV[q][0];
            }
        }
    }

    Energy energy(const double* u) override {
        for_each_batch([&](int b, Workspace& w) {
            const Batch& batch = batches_.all[b];
            const LaneMask valid = strains(batch, u, alpha_converged_, w);
            for (int lane = 0; lane < batch.count; ++lane) {
                const int e = batch.element[lane];
                energy_[e] = Energy{};
                if (!valid[lane]) continue;
                for (int q = 0; q < points(); ++q)
                    for (int p = 0; p < 6; ++p) w.E[q][p] = w.shell.E[q][p][lane];
                material_->energy(points(), w.E.data(), history_.state(e), w.energy.data());
                energy_[e] = {0.0, 0.0};
                for (int q = 0; q < points(); ++q) {
                    energy_[e].elastic += w.energy[q].elastic * w.shell.dV[q][lane];
                    energy_[e].plastic += w.energy[q].plastic * w.shell.dV[q][lane];
                }
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
    /// Of one thread.
    struct Workspace {
        typename Element::Workspace shell;
        typename Element::Nodal X, u;
        std::vector<Lanes> alpha;
        NodalResults<Nodes> results;
        std::vector<Voigt> E;        // [q] of one element
        std::vector<Energy> energy;  // [q]
    };

    void prepare_workspaces(int threads) {
        while (static_cast<int>(workspaces_.size()) < threads)
            workspaces_.push_back({element_.workspace(),
                                   {},
                                   {},
                                   std::vector<Lanes>(element_.modes()),
                                   {},
                                   std::vector<Voigt>(points()),
                                   std::vector<Energy>(points())});
    }

    /// Calls work(batch, workspace) for all batches, in parallel within a colour.
    template <class Work>
    void for_each_batch(const Work& work) {
        const int threads = thread_count();  // once: another thread may change it while this one works
        prepare_workspaces(threads);
        for_each_by_colour(batches_.colours, part_.size(), threads,
                           [&](int b, int thread) { work(b, workspaces_[thread]); });
    }

    static Batch alone(int e) {
        Batch batch{{}, 1};
        batch.element.fill(e);
        return batch;
    }
    static LaneTrials filled(double* trial) {
        LaneTrials trials;
        trials.fill(trial);
        return trials;
    }

    LaneTrials trial_of(const Batch& batch) {
        LaneTrials trial;
        for (int lane = 0; lane < lane_count; ++lane) trial[lane] = history_.trial(batch.element[lane]);
        return trial;
    }

    /// Asks the material at the points of the `wanted` elements; `trial` takes the new history.
    LaneMask respond(const Batch& batch, LaneMask wanted, const LaneTrials& trial, Workspace& w) const {
        LaneStates state;
        for (int lane = 0; lane < lane_count; ++lane) state[lane] = history_.state(batch.element[lane]);
        return material_->respond(points(), wanted & batch.filled(), w.shell.E.data(), state, w.shell.S.data(),
                                  w.shell.CC.data(), trial);
    }

    /// Strains at u with the enhanced parameters `alpha` of all elements. False where an element is inverted.
    LaneMask strains(const Batch& batch, const double* u, const std::vector<double>& alpha, Workspace& w) const {
        gather<Nodes>(part_, batch, X_.data(), w.X);
        gather<Nodes>(part_, batch, u, w.u);
        const std::size_t modes = element_.modes();
        for (std::size_t m = 0; m < modes; ++m)
            w.alpha[m] = by_lane([&](int lane) { return alpha[batch.element[lane] * modes + m]; });
        return element_.strains(w.X, w.u, w.alpha.data(), w.shell);
    }

    LaneMask compute(const Batch& batch, const double* u, bool tangent, const std::vector<double>& correction,
                     const LaneTrials& trial, Workspace& w) const {
        LaneMask good = strains(batch, u, alpha_, w);
        good = respond(batch, good, trial, w);
        if (!any(good)) return good;
        const bool corrected = tangent && !correction.empty();  // only the geometric stiffness knows the correction
        if (corrected) {
            gather<Nodes>(part_, batch, correction.data(), w.u);
            element_.quadratic_strains(w.u, w.shell);
        }
        element_.integrate({tangent, corrected}, w.shell);
        good = good & element_.condense(tangent, w.shell);
        w.results.set_forces(w.shell.f.data());
        if (tangent) w.results.set_tangent(w.shell.Kmm.data(), w.shell.Kdm.data(), w.shell.Kdd.data());
        return good;
    }

    /// Local frame and compatible deformation gradient F = g_m (x) G^m of the element in the first lane at point q.
    void write_base(int q, const Workspace& w, double* frame, double* F) const {
        std::array<Vec3, 3> G, g;
        element_.base_vectors(q, 0, w.shell, G, g);
        const auto local = local_frame(G);
        const Mat3 G_inverse =
            inverse(Mat3{{G[0][0], G[1][0], G[2][0], G[0][1], G[1][1], G[2][1], G[0][2], G[1][2], G[2][2]}});
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) {
                frame[3 * i + k] = local[i][k];
                F[3 * i + k] = g[0][i] * G_inverse(0, k) + g[1][i] * G_inverse(1, k) + g[2][i] * G_inverse(2, k);
            }
    }

    Element element_;
    std::shared_ptr<const Material> material_;
    Connectivity part_;
    std::vector<double> X_;
    Batches batches_;
    std::vector<Workspace> workspaces_;  // one a thread
    std::vector<Lanes> y_, Y_;           // [batch] Kaa^-1 ra, Kaa^-1 Kad of the last evaluate
    std::vector<double> scale_;
    std::vector<char> failed_;
    std::vector<Energy> energy_;
};

// Instantiated in cpp/src, one file each, so that they compile in parallel.
extern template class ShellBlockOf<8>;
extern template class ShellBlockOf<18>;

}  // namespace umform
