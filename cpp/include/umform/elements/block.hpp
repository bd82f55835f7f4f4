// Solid-shells of one kind: their history, and their share of residual and tangent.
#pragma once

#include <limits>
#include <stdexcept>

#include "umform/assembly/batch.hpp"
#include "umform/elements/shell_block.hpp"
#include "umform/elements/solid_shell.hpp"

namespace umform {

template <int Nodes>
class ShellBlockOf final : public ShellBlock {
  public:
    using Element = SolidShell<Nodes, Lanes>;
    static constexpr int size = Element::size;

    ShellBlockOf(const Technology& technology, const SurfacePoints& surface_points, const ThicknessRule& thickness,
                 std::shared_ptr<const Material> material, Connectivity part, std::vector<double> X,
                 std::vector<double> rolling = {})
        : element_(technology, surface_points, thickness, material->symmetric()), material_(std::move(material)),
          part_(std::move(part)), X_(std::move(X)), rolling_(std::move(rolling)),
          turns_(part_, make_colours_of_groups(part_, lane_count), lane_count), batches_(make_batches(turns_)) {
        const std::size_t elements = part_.size(), modes = element_.modes();
        history_ = History(part_.size(), element_.points(), material_->history_variables());
        history_.initialise([this](double* state) { material_->initial(state); });
        alpha_.assign(elements * modes, 0.0);
        alpha_before_ = alpha_converged_ = alpha_;
        scale_.resize(elements);
        failed_.resize(elements);
        energy_.resize(elements);
        check_rolling();
    }

    const Connectivity& connectivity() const override { return part_; }
    std::size_t dofs() const override { return X_.size(); }
    int points() const override { return element_.points(); }
    int modes() const override { return element_.modes(); }
    int state_size() const override { return material_->state_size(); }

    bool symmetric() const override { return element_.symmetric(); }

    Outcome evaluate(const double* u, const Scatter& scatter, const Target& target) override {
        if (target.values != nullptr) scatter.require(symmetric(), "the law of the elements");
        if (target.wants_tangent())
            begin_blocks();
        else
            followed_.resize(batches_.size() * element_.modes());
        for_each_batch(points(), [&](int b, Workspace& w, const auto& turn) {
            const Batch& batch = batches_[b];
            const Failures failures = compute(batch, u, target.wants_tangent(), correction_, trial_of(batch), w);
            const std::size_t modes = element_.modes();
            std::vector<Lanes>& y = target.wants_tangent() ? last_.y : followed_;
            std::copy(w.shell.ra.begin(), w.shell.ra.end(), y.begin() + b * modes);
            if (target.wants_tangent()) {
                std::copy(w.shell.Kad.begin(), w.shell.Kad.end(), last_.Y.begin() + b * modes * size);
            }
            turn();
            for (int lane = 0; lane < batch.count; ++lane) {
                const int e = batch.element[lane];
                failed_[e] = failures[lane];
                if (failed_[e] != Failure::None) continue;
                const std::array<double, size>& f = w.results.f[lane];
                scale_[e] = dot(f, f);
                scatter_element<Nodes>(part_, scatter, e, w.results.K[lane].data(), f.data(), target, !symmetric());
            }
        });
        Outcome outcome;
        for (int e = 0; e < part_.size(); ++e) {
            if (failed_[e] != Failure::None && outcome.failed < 0) outcome.failed = e, outcome.failure = failed_[e];
            outcome.force_scale_squared += scale_[e];
        }
        note_change(target.wants_tangent() ? last_.y : followed_);
        return outcome;
    }

    void recover_enhanced(const double* du) override {
        const int modes = element_.modes();
        const Eliminated& from = from_kept_ ? kept_ : last_;
        if (from.y.empty()) return;  // nothing has been evaluated yet
        for_each_batch(1, [&](int b, Workspace& w, const auto&) {
            const Batch& batch = batches_[b];
            gather<Nodes>(part_, batch, du, w.u);
            for (int m = 0; m < modes; ++m) {
                const std::size_t row = static_cast<std::size_t>(b) * modes + m;
                Lanes sum = 0.0;
                for (int i = 0; i < size; ++i) sum += from.Y[row * size + i] * w.u[i];
                const Lanes change = from.y[row] + sum;
                for (int lane = 0; lane < batch.count; ++lane)
                    alpha_[static_cast<std::size_t>(batch.element[lane]) * modes + m] -= change[lane];
            }
        });
    }

    void take_blocks(const ShellBlock& of) override {
        const auto& other = dynamic_cast<const ShellBlockOf&>(of);
        last_.Y = (other.from_kept_ ? other.kept_ : other.last_).Y;
        last_.y.resize(last_.Y.size() / size);
        from_kept_ = false;
    }
    void follow() override {
        if (!from_kept_ && last_.y.size() == followed_.size()) std::swap(last_.y, followed_);
    }

    std::uint64_t staged_returns() const override { return material_->staged_returns(); }
    bool keeps_blocks() const override { return keeps_ || element_.modes() == 0; }
    void keep_blocks() override {
        if (from_kept_) return;
        std::swap(last_, kept_);
        from_kept_ = keeps_ = !kept_.y.empty();
    }
    void return_to_kept_blocks() override { from_kept_ = keeps_; }
    void forget_blocks() override { from_kept_ = keeps_ = false; }

    void element(int e, const double* u, double* K, double* f) override;
    std::pair<int, Voigt> failing_point(int e, const double* u) override;
    void fields(const double* u, const PointFields& out) override;
    void fields(const double* u, const CellFields& out) override;
    Energy energy(const double* u) override;

  private:
    /// What the elimination of the enhanced parameters leaves: [batch] Kaa^-1 ra, Kaa^-1 Kad.
    struct Eliminated {
        std::vector<Lanes> y, Y;
    };

    /// The blocks of the evaluation that begins take the place of those of the last one.
    void begin_blocks() {
        const std::size_t rows = batches_.size() * element_.modes();
        last_.y.resize(rows);
        last_.Y.resize(rows * size);
        from_kept_ = false;
    }

    /// Of the elements that have not failed.
    void note_change(const std::vector<Lanes>& y) {
        const std::size_t modes = element_.modes();
        enhanced_change_ = 0.0;
        for (std::size_t b = 0; b < batches_.size(); ++b)
            for (int lane = 0; lane < batches_[b].count; ++lane) {
                if (failed_[batches_[b].element[lane]] != Failure::None) continue;
                for (std::size_t m = 0; m < modes; ++m)
                    enhanced_change_ = std::max(enhanced_change_, std::abs(y[b * modes + m][lane]));
            }
    }

    using Failures = std::array<Failure, lane_count>;

    /// Of one thread.
    struct Workspace {
        typename Element::Workspace shell;
        typename Element::Nodal X, u;
        std::vector<Lanes> alpha;
        Vec<Lanes, 3> rolling;
        std::vector<Axes<Lanes>> axes;  // [q], for laws that need them
        NodalResults<Nodes> results;
        std::vector<Voigt> E;         // [q] of one element
        std::vector<Energy> energy;   // [q]
        std::vector<double> scratch;  // [lane] history that is discarded
    };

    void prepare_workspaces(int threads) {
        while (static_cast<int>(workspaces_.size()) < threads)
            workspaces_.push_back({element_.workspace(),
                                   {},
                                   {},
                                   std::vector<Lanes>(element_.modes()),
                                   {},
                                   {},
                                   {},
                                   std::vector<Voigt>(points()),
                                   std::vector<Energy>(points()),
                                   {}});
    }

    /// Calls work(batch, workspace, turn) for all batches, which calls turn() before it adds anything at their nodes; an element
    /// takes as long as so many points.
    template <class Work>
    void for_each_batch(int as_points, const Work& work) {
        const int threads = thread_count();  // once: another thread may change it while this one works
        prepare_workspaces(threads);
        turns_.run(part_.size() < points_worth_a_team / as_points ? 1 : threads,
                   [&](int b, int thread, const auto& turn) { work(b, workspaces_[thread], turn); });
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

    /// What the material sees of the points of the elements in the lanes.
    LanePoints seen(const Batch& batch, double time, Workspace& w) const {
        LanePoints points;
        points.step = time;
        for (int lane = 0; lane < lane_count; ++lane) points.cell[lane] = number_of(batch.element[lane]);
        if (material_->sees_points()) {
            element_.axes(rolling(w), w.shell, w.axes);
            points.axes = w.axes.data();
            points.size = element_.length(w.shell);
        }
        return points;
    }

    /// Evaluates the material at the points of the `wanted` elements for a time increment; `trial` gets the new history.
    LaneMask respond(const Batch& batch, LaneMask wanted, const LaneTrials& trial, double time, Workspace& w) const {
        LaneStates state;
        for (int lane = 0; lane < lane_count; ++lane) state[lane] = history_.state(batch.element[lane]);
        const LanePoints points = seen(batch, time, w);
        const auto ask = [&](LaneMask mask, const Vec<Lanes, 6>* E) {
            return material_->respond(element_.points(), mask, E, state, w.shell.S.data(), w.shell.CC.data(), trial,
                                      points);
        };
        try {
            return ask(wanted & batch.filled(), w.shell.E.data());
        } catch (const std::logic_error& error) {
            name_cell(batch, ask, w, error.what());
        } catch (const std::runtime_error& error) {
            name_cell(batch, ask, w, error.what());
        }
    }

    /// Throws an error of the law again with the number of the element that it comes from, which is the one that throws alone.
    template <class Ask>
    [[noreturn]] void name_cell(const Batch& batch, const Ask& ask, const Workspace& w, const std::string& what) const {
        for (int lane = 0; lane < batch.count; ++lane) {
            std::vector<Vec<Lanes, 6>> E(w.shell.E.size());
            for (std::size_t q = 0; q < E.size(); ++q)
                for (int p = 0; p < 6; ++p) E[q][p] = w.shell.E[q][p][lane];
            LaneMask alone = false;
            alone.set(lane, true);
            try {
                ask(alone, E.data());
            } catch (const std::exception&) {
                throw std::runtime_error("cell " + std::to_string(number_of(batch.element[lane])) + ": " + what);
            }
        }
        throw std::runtime_error("cell " + std::to_string(number_of(batch.element[0])) + " or a neighbour: " + what);
    }

    /// Strains at u with the enhanced parameters `alpha` of all elements. False where an element is turned inside out.
    LaneMask strains(const Batch& batch, const double* u, const std::vector<double>& alpha, Workspace& w) const {
        gather<Nodes>(part_, batch, X_.data(), w.X);
        gather<Nodes>(part_, batch, u, w.u);
        const std::size_t modes = element_.modes();
        for (std::size_t m = 0; m < modes; ++m)
            w.alpha[m] = by_lane([&](int lane) { return alpha[batch.element[lane] * modes + m]; });
        gather_rolling(batch, w);
        return element_.strains(w.X, w.u, w.alpha.data(), rolling(w), w.shell);
    }

    /// Residual, and tangent if requested, of the elements in the lanes; the cause of failures.
    Failures compute(const Batch& batch, const double* u, bool tangent, const std::vector<double>& correction,
                     const LaneTrials& trial, Workspace& w) const {
        Failures failures{};
        LaneMask good = strains(batch, u, alpha_, w);
        mark(good, Failure::Inverted, failures);
        good = respond(batch, good, trial, step, w);
        mark(good | !batch.filled(), Failure::Law, failures);
        if (!any(good)) return failures;
        const bool corrected = tangent && !correction.empty();  // only the geometric stiffness knows the correction
        if (corrected) {
            gather<Nodes>(part_, batch, correction.data(), w.u);
            element_.quadratic_strains(w.u, w.shell);
        }
        element_.integrate({tangent, corrected}, w.shell);
        mark(element_.condense(tangent, w.shell), Failure::Condensed, failures);
        w.results.set_forces(w.shell.f.data());
        if (!tangent) return failures;
        if (symmetric())
            w.results.set_tangent(w.shell.Kmm.data(), w.shell.Kdm.data(), w.shell.Kdd.data());
        else
            w.results.set_tangent_full(w.shell.Kmm.data(), w.shell.Kdm.data(), w.shell.Kmd.data(), w.shell.Kdd.data());
        return failures;
    }

    static void mark(LaneMask good, Failure why, Failures& failures) {
        for (int lane = 0; lane < lane_count; ++lane)
            if (!good[lane] && failures[lane] == Failure::None) failures[lane] = why;
    }

    void require(int e, Failure failure) const {
        if (failure != Failure::None)
            throw std::domain_error("cell " + std::to_string(number_of(e)) + " " + describe(failure));
    }

    // Rolling direction ----------------------------------------------------------------------------------------

    /// Of the elements in the lanes, or null where the frame follows G_1.
    const Vec<Lanes, 3>* rolling(const Workspace& w) const { return rolling_.empty() ? nullptr : &w.rolling; }

    void gather_rolling(const Batch& batch, Workspace& w) const {
        if (rolling_.empty()) return;
        const std::size_t stride = rolling_.size() == 3 ? 0 : 3;
        for (int k = 0; k < 3; ++k)
            w.rolling[k] = by_lane([&](int lane) { return rolling_[stride * batch.element[lane] + k]; });
    }

    /// Refuses a rolling direction that stands on the sheet.
    void check_rolling();

    /// Calls write(batch, good, workspace) with strains and stresses at u, and refuses elements that have none.
    template <class Write>
    void for_each_response(const double* u, const Write& write);
    /// Fields of the element in a lane.
    void write_fields(int e, int lane, const Workspace& w, const PointFields& out) const;
    void write_fields(const Batch& batch, LaneMask good, const Workspace& w, const CellFields& out) const;
    /// Local frame and compatible deformation gradient F = g_m (x) G^m of the element in a lane at point q.
    void write_base(int q, int lane, const Workspace& w, double* frame, double* F) const;

    Element element_;
    std::shared_ptr<const Material> material_;
    Connectivity part_;
    std::vector<double> X_;
    std::vector<double> rolling_;  // none, one, or one for each element
    Turns turns_;
    std::vector<Batch> batches_;
    std::vector<Workspace> workspaces_;  // one a thread
    Eliminated last_, kept_;             // of the last evaluate with a tangent, and of the converged state
    std::vector<Lanes> followed_;        // y of the last evaluate without one
    bool from_kept_ = false, keeps_ = false;
    std::vector<double> scale_;
    std::vector<Failure> failed_;
    std::vector<Energy> energy_;
};

// Instantiated in cpp/src, one file each, so that they compile in parallel; what is only declared here is in block_output.hpp.
extern template class ShellBlockOf<8>;
extern template class ShellBlockOf<18>;

}  // namespace umform
