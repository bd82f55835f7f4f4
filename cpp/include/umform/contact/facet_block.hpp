// Contact of element faces with one rigid tool, integrated over the reference area.
#pragma once

#include "umform/assembly/turns.hpp"
#include "umform/contact/block.hpp"
#include "umform/contact/locator.hpp"
#include "umform/contact/penalty.hpp"
#include "umform/contact/points.hpp"

namespace umform {

template <int Nodes, class FaceRule = AtPoints<Nodes>>
class ContactBlockOf final : public ContactBlock {
  public:
    static constexpr int size = 3 * Nodes;

    ContactBlockOf(const Connectivity& part, const std::vector<double>& X, typename FaceRule::Setting setting,
                   const std::shared_ptr<const Surface>& surface, std::shared_ptr<ContactLaw> law)
        : ContactBlock(std::move(law)), rule_(part, X, setting), locator_(part, X, rule_, surface),
          turns_(part, make_colours(part), facets_of_a_turn), scale_(part.size()), place_(part.size()) {
        area_ = rule_.area;
        std::vector<HistoryVariable> history_variables = law_->history_variables();
        for (const HistoryVariable& quantity : history_variables) of_law_ += quantity.size;
        for (const HistoryVariable& quantity : FaceRule::table.list()) history_variables.push_back(quantity);
        history_ = History(part.size(), rule_.count(), std::move(history_variables));
    }

    int per_facet() const override { return rule_.count(); }
    bool symmetric() const override { return FaceRule::symmetric && law_->symmetric(); }

    const Connectivity& connectivity() const override { return locator_.part(); }
    std::size_t dofs() const override { return locator_.dofs(); }

    std::vector<double> shape_values() const override {
        std::vector<double> values;
        for (std::size_t i = 0; i < rule_.N.size(); ++i)
            if (static_cast<int>(i % rule_.places()) < rule_.count())
                values.insert(values.end(), rule_.N[i].begin(), rule_.N[i].end());
        return values;
    }

    void locate(const double* u) override {
        answered_ = false;
        locator_.move(u, pose, thread_count(), [this](int e) { return reach(e); });
    }

    std::vector<Vec3> positions() override { return of_points(complete().positions()); }
    std::vector<double> gaps() override { return of_points(complete().gaps()); }
    std::vector<Vec3> normals() override { return of_points(complete().normals()); }

    /// f_a = -int N_a t dA, K_ab = int N_a N_b (-dt/dx) dA with the traction t of the law at the points. eqs. (4.9), (4.10), (4.87)
    Outcome evaluate(const double* u, const Scatter& scatter, const Target& target) override {
        if (target.values != nullptr) scatter.require(symmetric(), name);
        const int threads = thread_count();  // once: another thread may change it while this one works
        answered_ = false;
        locator_.move(u, pose, threads,
                      [this](int e) { return keeps(e) ? std::numeric_limits<double>::infinity() : reach(e); });
        const int near = number_near();
        while (static_cast<int>(answers_.size()) < near) answers_.emplace_back(per_facet());
        while (static_cast<int>(spare_.size()) < threads) spare_.emplace_back(per_facet());
        turns_.run(connectivity().size() < facets_worth_a_team ? 1 : threads,
                   [&](int group, int thread, const auto& turn) {
                       for (const int e : turns_.elements(group)) add_facet(e, scatter, target, spare_[thread], turn);
                   });
        kept.clear();
        answered_ = true, of_penalty_ = law_->penalty(), of_open_ = open;
        Outcome outcome;
        for (const double scale : scale_) outcome.force_scale_squared += scale;
        return outcome;
    }

    std::vector<Reaction> reactions() override {
        std::vector<Reaction> reactions(points(), Reaction{});
        for_each_held([&](int, int q, const Reaction& reaction, const Workspace&) { reactions[q] = reaction; });
        return reactions;
    }

    ContactFound found() override {
        ContactFound found;
        found.active.assign(points(), 0);
        RoundOff round_off;
        for_each_near([&](int e, int q, const Workspace& workspace, const double* history) {
            const int i = q - e * per_facet();
            const Reaction& reaction = workspace.reactions[i];
            const Rubbing rubbing = law_->rubbing(history);
            add_works(found, area_[q], rubbing, rule_.contact_work(history + of_law_));
            if (!reaction.held) return;
            round_off.add(e, weight_of_errors(q, history), values_at(e, q));
            const Vec3 &x = locator_.positions()[at(q)], &n = locator_.normals()[at(q)];
            found.active[q] = reaction.slipping ? 2 : 1;
            found.points.push_back(q);
            found.x.push_back(x), found.normal.push_back(n);
            found.traction.push_back(reaction.traction(n));
            found.gap.push_back(rule_.gap(*law_, locator_, e, i, workspace, history));
            found.share.push_back(rule_.share(workspace, i)), found.pressure.push_back(reaction.pressure);
            found.elastic_slip.push_back(locator_.pose().turn(rubbing.elastic_slip));
            found.tangential_stiffness.push_back(rubbing.stiffness);
            found.slip.push_back(rubbing.slip);
            found.area.push_back(area_[q]);
            const Vec3 force = reaction.force(n, area_[q]);
            found.force.push_back({-force[0], -force[1], -force[2]});
        });
        add_works_of_far(found);
        found.penetration = penetration();
        found.round_off_squared = round_off.squared();
        return found;
    }

    std::vector<double> row(const Vec3& w, const Vec3& omega, const Vec3& p) override {
        // v = sum N_a v_a with v_a = w + omega x (x_a - p): the sum is that of -f_a . v_a, and dv_a/du_a = omega x.
        std::vector<double> row(dofs(), 0.0);
        Element element;
        for_each_answer([&](int e, const Workspace& answer, const double*) {
            if (!form(e, answer, true, element)) return;
            const std::int32_t* ids = connectivity()[e];
            std::array<double, size> way;
            for (int a = 0; a < Nodes; ++a) {
                const Vec3& x = locator_.node(e, a);
                const Vec3 turned = cross(omega, {x[0] - p[0], x[1] - p[1], x[2] - p[2]});
                for (int k = 0; k < 3; ++k) way[k * Nodes + a] = w[k] + turned[k];
            }
            for (int b = 0; b < Nodes; ++b) {
                const Vec3 turning = cross({element.f[b], element.f[Nodes + b], element.f[2 * Nodes + b]}, omega);
                for (int l = 0; l < 3; ++l) {
                    double value = -turning[l];
                    for (int k = 0; k < 3; ++k)
                        for (int a = 0; a < Nodes; ++a) {
                            const int i = k * Nodes + a, j = l * Nodes + b;
                            const bool stored = !symmetric() || k <= l;
                            value -= way[i] * element.K[stored ? i * size + j : j * size + i];
                        }
                    row[3 * ids[b] + l] += value;
                }
            }
        });
        return row;
    }

    double round_off_squared() override {
        RoundOff round_off;
        for_each_near([&](int e, int q, const Workspace& workspace, const double* history) {
            if (workspace.reactions[q - e * per_facet()].held)
                round_off.add(e, weight_of_errors(q, history), values_at(e, q));
        });
        return round_off.squared();
    }

    double penetration() override {
        double deepest = 0.0;
        for (int e = 0; e < connectivity().size(); ++e) {
            if (open || locator_.far(e)) continue;
            for (int q = 0; q < per_facet(); ++q) deepest = std::max(deepest, rule_.penetration(locator_, e, q));
        }
        return deepest;
    }

    void begin() override {
        if (begun_ || !law_->follows_places()) return;
        for (int e = 0; e < connectivity().size(); ++e) leave_law(e, history_.trial(e));
        const std::vector<double> places = history_.trial();
        history_.restore(places.data(), places.size());
        answered_ = false;
    }

    void augment(const Vec3* tractions) override {
        if (!law_->follows_places()) return;
        for_each_held([&](int e, int q, const Reaction&, const Workspace&) {
            const Place place = locator_.places(e)[q % per_facet()];
            law_->augment(place, tractions[q], history_.state(e) + history_.size() * (q % per_facet()),
                          history_.point(q));
        });
        answered_ = false;
    }

    int far_facets() const override {
        int count = 0;
        for (int e = 0; e < connectivity().size(); ++e) count += locator_.far(e) ? 1 : 0;
        return count;
    }

  private:
    using Values = std::array<double, Nodes>;
    using Workspace = typename FaceRule::Workspace;

    /// Sum over facets and nodes of the squares of what errors of the positions make of the forces at the nodes.
    class RoundOff {
      public:
        /// The points of a facet, which follow each other, share its nodes: their errors may all point one way.
        void add(int facet, double weight, const Values& N) {
            if (facet != facet_) squared(), facet_ = facet;
            for (int a = 0; a < Nodes; ++a) force_[a] += weight * std::abs(N[a]);
        }
        double squared() {
            for (double& value : force_) sum_ += value * value, value = 0.0;
            return sum_;
        }

      private:
        Values force_{};
        int facet_ = -1;
        double sum_ = 0.0;
    };

    /// K and f of a facet, [direction][node].
    struct Element {
        alignas(64) std::array<double, static_cast<std::size_t>(size) * size> K;
        std::array<double, size> f;
    };

    bool remembers() const { return FaceRule::remembers || law_->follows_places(); }

    /// What the points of a facet remember that nothing holds: what the law does, and the rule.
    void leave_law(int e, double* trial) const {
        for (int q = 0; law_->follows_places() && q < per_facet(); ++q) {
            const double* state = history_.state(e) + history_.size() * q;
            double* of_point = trial + history_.size() * q;
            if (open)
                law_->let_go(locator_.in_tool(e, q), state, of_point);
            else
                law_->leave(locator_.in_tool(e, q), state, of_point);
        }
    }

    void leave(int e, double* trial) const {
        leave_law(e, trial);
        for (int q = 0; FaceRule::remembers && q < per_facet(); ++q) {
            const int at = history_.size() * q + of_law_;
            rule_.leave(history_.state(e) + at, trial + at);
        }
    }

    static void add_works(ContactFound& found, double area, const Rubbing& rubbing, double contact_work) {
        found.friction_work += area * rubbing.work, found.work_above_mean += area * rubbing.above;
        found.stored += area * rubbing.stored, found.contact_work += area * contact_work;
    }

    /// Works of friction and pressure so far at the points of far facets, and what their law has stored.
    void add_works_of_far(ContactFound& found) const {
        if (!remembers()) return;
        const bool known = answers();
        std::vector<double> left(history_.stride());
        for (int e = 0; e < connectivity().size(); ++e) {
            if (!open && near(e)) continue;
            const double* rows = history_.trial(e);
            if (!known) leave(e, left.data()), rows = left.data();
            for (int q = 0; q < per_facet(); ++q) {
                const double *row = rows + history_.size() * q, area = area_[e * per_facet() + q];
                add_works(found, area, law_->rubbing(row), rule_.contact_work(row + of_law_));
            }
        }
    }

    /// Number of a point among the places of the locator.
    std::size_t at(int q) const {
        return static_cast<std::size_t>(q / per_facet()) * locator_.points() + q % per_facet();
    }
    /// Of values at all places those of the points.
    template <class T>
    std::vector<T> of_points(const std::vector<T>& values) const {
        std::vector<T> found(points());
        for (int q = 0; q < points(); ++q) found[q] = values[at(q)];
        return found;
    }
    double weight_of_errors(int q, const double* history) const {
        return law_->stiffness(history) * area_[q] * largest_length(q);
    }
    const Values& values_at(int e, int q) const { return locator_.shapes(e)[q - e * per_facet()]; }

    double reach(int e) const { return law_->reach(per_facet(), history_.trial(e), history_.size()); }

    const Locator<Nodes>& complete() {
        locator_.complete(thread_count());
        return locator_;
    }

    /// Asks the law at the points of a facet.
    void respond(int e, double* trial, Workspace& answer) const {
        rule_.respond(*law_, locator_, e, {history_.state(e), trial, history_.size(), of_law_}, answer);
    }

    /// Numbers the facets that are not far, and returns how many there are.
    int number_near() {
        int count = 0;
        for (int e = 0; e < connectivity().size(); ++e) place_[e] = locator_.far(e) ? -1 : count++;
        return count;
    }

    /// Whether the answers of the law in the last `evaluate` hold still.
    bool answers() const { return answered_ && law_->penalty() == of_penalty_ && open == of_open_; }
    /// Whether the law is asked at a facet, or has been. Those that were far may have been located since.
    bool near(int e) const { return answers() ? place_[e] >= 0 : !locator_.far(e); }

    /// Calls work(facet, answer of the law, new history) for all facets that are not far, in their order; the trial history is
    /// unchanged.
    template <class Work>
    void for_each_answer(const Work& work) {
        if (open) return;
        const bool known = answers();
        if (!known) locator_.settle([this](int e) { return reach(e); });
        Workspace answer(per_facet());
        std::vector<double> trial(history_.stride());
        for (int e = 0; e < connectivity().size(); ++e) {
            if (!near(e)) continue;
            if (known) {
                work(e, answers_[place_[e]], history_.trial(e));
                continue;
            }
            std::copy_n(history_.trial(e), trial.size(), trial.begin());
            respond(e, trial.data(), answer);
            work(e, answer, trial.data());
        }
    }

    /// Calls work(facet, point, answer, new history) for all points of these facets.
    template <class Work>
    void for_each_near(const Work& work) {
        for_each_answer([&](int e, const Workspace& answer, const double* rows) {
            for (int q = 0; q < per_facet(); ++q) work(e, e * per_facet() + q, answer, rows + history_.size() * q);
        });
    }

    /// Calls work(facet, point, reaction, workspace) for all points that are held now, in their order.
    template <class Work>
    void for_each_held(const Work& work) {
        for_each_near([&](int e, int q, const Workspace& workspace, const double*) {
            const Reaction& reaction = workspace.reactions[q - e * per_facet()];
            if (reaction.held) work(e, q, reaction, workspace);
        });
    }

    /// Forces and, if requested, the tangent of a facet; whether the tool holds it anywhere.
    bool form(int e, const Workspace& answer, bool tangent, Element& element) const {
        bool active = false;
        for (const Reaction& reaction : answer.reactions) active = active || reaction.held;
        if (!active) return false;
        element.f.fill(0.0);
        if (tangent) element.K.fill(0.0);
        const double* areas = area_.data() + static_cast<std::size_t>(e) * per_facet();
        for (int q = 0; q < per_facet(); ++q)
            if (answer.reactions[q].held)
                rule_.add(*law_, locator_, e, q, areas[q], answer, tangent, element.K.data(), element.f.data());
        return true;
    }

    bool keeps(int e) const {
        if (kept.empty()) return false;
        const std::uint8_t* first = kept.data() + static_cast<std::size_t>(e) * per_facet();
        return std::any_of(first, first + per_facet(), [](std::uint8_t one) { return one != 0; });
    }

    /// Holds the kept points that are open: frictionless, with tension. eq. (4.230)
    void hold_kept(int e, const double* trial, Workspace& answer) const {
        const Penalty law{law_->penalty()};
        for (int q = 0; q < per_facet(); ++q) {
            Reaction& reaction = answer.reactions[q];
            if (reaction.held || kept[static_cast<std::size_t>(e) * per_facet() + q] == 0) continue;
            law.hold(locator_.places(e)[q], trial + history_.size() * q, reaction);
            reaction.held = true;
        }
    }

    template <class Turn>
    void add_facet(int e, const Scatter& scatter, const Target& target, Workspace& spare, const Turn& turn) {
        scale_[e] = 0.0;
        if (open || locator_.far(e)) {
            if (remembers()) leave(e, history_.trial(e));
            return;
        }
        Element element;
        Workspace& answer = answers_[place_[e]];
        respond(e, history_.trial(e), answer);
        const bool keeps_any = keeps(e);
        if (keeps_any) spare = answer, hold_kept(e, history_.trial(e), spare);
        if (!form(e, keeps_any ? spare : answer, target.wants_tangent(), element)) return;
        for (const double value : element.f) scale_[e] += value * value;
        turn();
        scatter_element<Nodes>(connectivity(), scatter, e, element.K.data(), element.f.data(), target, !symmetric());
    }

    /// Length of the largest number that the gap of point q is a difference of: the position in space, that of the tool,
    /// or the distance from the centre of curvature, 1/|H|. eq. (5.35)
    double largest_length(int q) const {
        const Vec3 &x = locator_.positions()[at(q)], &c = locator_.pose().c;
        const double place = std::sqrt(dot(x, x)) + std::sqrt(dot(c, c));
        double curvature = 0.0;
        for (const double value : locator_.hessians()[at(q)].a) curvature += value * value;
        curvature = std::sqrt(curvature);
        return curvature * flattest * place > 1.0 ? place + 1.0 / curvature : place;
    }

    /// Radii above so many times the place of a point are those of a plane, whose H may be noise.
    static constexpr double flattest = 1e3;

    FaceRule rule_;
    Locator<Nodes> locator_;
    Turns turns_;
    std::vector<double> scale_;
    std::vector<std::int32_t> place_;  // [facet] in `answers_`, or -1: far
    std::vector<Workspace> answers_;   // of the law in the last `evaluate`, without kept points
    std::vector<Workspace> spare_;     // one a thread: with kept points
    double of_penalty_ = 0.0;          // in the last `evaluate`
    bool of_open_ = false;
    int of_law_ = 0;  // numbers of a point's history that are the law's
};

}  // namespace umform
