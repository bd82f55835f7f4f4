// Contact of element faces with one rigid tool, integrated over the reference area.
#pragma once

#include "umform/assembly/colours.hpp"
#include "umform/assembly/target.hpp"
#include "umform/contact/concept.hpp"
#include "umform/contact/found.hpp"
#include "umform/contact/locator.hpp"

namespace umform {

/// The facets of a pair as Python sees them. `evaluate` reads the converged history and writes the trial history; multipliers are
/// the part of it that an outer loop sets between evaluations. What is asked for after `evaluate` or `locate` belongs to the
/// positions that they were given, and to the present multipliers and penalty.
class ContactBlock {
  public:
    explicit ContactBlock(std::shared_ptr<ContactLaw> law) : law_(std::move(law)) {}
    virtual ~ContactBlock() = default;
    virtual const Connectivity& connectivity() const = 0;
    virtual std::size_t dofs() const = 0;  // length of u and f
    virtual Outcome evaluate(const double* u, const Scatter& scatter, const Target& target) = 0;
    /// Moves the contact points to x = X + u, and measures their gaps to the tool in its present pose.
    virtual void locate(const double* u) = 0;
    /// Shape functions at the contact points of a facet, [point][node].
    virtual std::vector<double> shape_values() const = 0;

    Pose pose;
    std::string name = "a contact";  // for messages

    const std::shared_ptr<ContactLaw>& law() const { return law_; }
    bool symmetric() const { return law_->symmetric(); }
    int points() const { return static_cast<int>(area_.size()); }
    const std::vector<double>& areas() const { return area_; }

    /// At all contact points, those of far facets too, which are located now.
    virtual const std::vector<Vec3>& positions() = 0;
    virtual const std::vector<double>& gaps() = 0;
    virtual const std::vector<Vec3>& normals() = 0;

    /// Tractions of the tool on the sheet at all points, as they are (not times area).
    virtual std::vector<Reaction> reactions() = 0;
    /// What is known of the points that are held, as a copy.
    virtual ContactFound found() = 0;
    /// Derivative of sum A t . v with v = w + omega x (x - p) over all points that are held, with respect to u [3 n]: that of the
    /// force, or moment, that a rigid motion of the tool is conjugate to. eq. (4.42)
    virtual std::vector<double> row(const Vec3& w, const Vec3& omega, const Vec3& p) = 0;
    /// Square of what a relative error of all positions makes of the residual, over the square of that error. eq. (5.36)
    virtual double round_off_squared() = 0;
    /// Largest penetration, zero if there is none.
    virtual double penetration() = 0;
    /// Facets that the last `evaluate` or `locate` did not have to look at.
    virtual int far_facets() const = 0;

    const History& history() const { return history_; }
    /// Pressures that are there without a penetration, zero or more: those of now, which `commit` makes converged.
    std::vector<double> multipliers() const {
        std::vector<double> values;
        values.reserve(points());
        for (int q = 0; q < points(); ++q) values.push_back(history_.trial(0)[q * history_.size()]);
        return values;
    }
    void set_multipliers(const double* values) {
        for (int q = 0; q < points(); ++q) history_.trial(0)[q * history_.size()] = values[q];
    }
    /// Lets multipliers carry tractions [point] along the tool at the points that are held. eq. (4.50)
    virtual void augment(const Vec3* tractions) = 0;
    /// Makes the places where the points are now, by `locate` or `evaluate`, those of a sheet that nothing has held before. It does
    /// nothing once there is a history.
    virtual void begin() = 0;
    bool begun() const { return begun_; }
    /// The history that the last `evaluate` has read, with the multipliers that it was to take: with it it can be repeated.
    std::vector<double> read() const {
        std::vector<double> read = history_.state();
        for (int q = 0; q < points(); ++q)
            law_->put_wanted(history_.point(q), read.data() + static_cast<std::size_t>(q) * history_.size());
        return read;
    }
    void commit() {
        begun_ = true;
        if (law_->follows_places())
            for (int q = 0; q < points(); ++q) law_->settle(history_.point(q));
        history_.commit();
    }
    void revert() { history_.revert(); }
    void restore(const double* state, std::size_t count) {
        history_.restore(state, count);
        begun_ = true;
    }

  protected:
    std::shared_ptr<ContactLaw> law_;
    std::vector<double> area_;  // [facet][point] reference area of a contact point
    History history_;           // [facet][point]
    bool begun_ = false;        // whether there is a history
};

template <int Nodes>
class ContactBlockOf final : public ContactBlock {
  public:
    static constexpr int size = 3 * Nodes;

    ContactBlockOf(const Connectivity& part, const std::vector<double>& X, ContactRule rule,
                   const std::shared_ptr<const Surface>& surface, std::shared_ptr<ContactLaw> law)
        : ContactBlockOf(part, X, FacetPoints<Nodes>(part, X, rule), surface, std::move(law)) {}

    const Connectivity& connectivity() const override { return locator_.part(); }
    std::size_t dofs() const override { return locator_.dofs(); }

    std::vector<double> shape_values() const override {
        std::vector<double> values;
        for (const Values& N : N_) values.insert(values.end(), N.begin(), N.end());
        return values;
    }

    void locate(const double* u) override {
        locator_.move(u, pose, thread_count(), [this](int e) { return reach(e); });
    }

    const std::vector<Vec3>& positions() override { return complete().positions(); }
    const std::vector<double>& gaps() override { return complete().gaps(); }
    const std::vector<Vec3>& normals() override { return complete().normals(); }

    /// f_a = -int N_a t dA, K_ab = int N_a N_b (-dt/dx) dA with the traction t of the law at the points. eqs. (4.9), (4.10)
    Outcome evaluate(const double* u, const Scatter& scatter, const Target& target) override {
        if (target.values != nullptr) scatter.require(symmetric(), name);
        const int threads = thread_count();  // once: another thread may change it while this one works
        locator_.move(u, pose, threads, [this](int e) { return reach(e); });
        while (static_cast<int>(workspaces_.size()) < threads) workspaces_.emplace_back(N_.size());
        for_each_by_colour(colours_, connectivity().size(), threads,
                           [&](int e, int thread) { add_facet(e, scatter, target, workspaces_[thread]); });
        Outcome outcome;
        for (const double scale : scale_) outcome.force_scale_squared += scale;
        return outcome;
    }

    std::vector<Reaction> reactions() override {
        std::vector<Reaction> reactions(points(), Reaction{});
        for_each_held([&](int, int q, const Reaction& reaction) { reactions[q] = reaction; });
        return reactions;
    }

    ContactFound found() override {
        ContactFound found;
        found.active.assign(points(), 0);
        RoundOff round_off;
        for_each_near([&](int e, int q, const Reaction& reaction, const double* history) {
            const Rubbing rubbing = law_->rubbing(history);
            found.friction_work += area_[q] * rubbing.work;
            found.stored += area_[q] * rubbing.stored;
            if (!reaction.held) return;
            round_off.add(e, weight_of_errors(q), values_at(q));
            const Vec3 &x = locator_.positions()[q], &n = locator_.normals()[q];
            found.active[q] = reaction.slipping ? 2 : 1;
            found.points.push_back(q);
            found.x.push_back(x), found.normal.push_back(n);
            found.traction.push_back(reaction.traction(n));
            found.gap.push_back(locator_.gaps()[q]), found.pressure.push_back(reaction.pressure);
            found.elastic_slip.push_back(locator_.pose().turn(rubbing.elastic_slip));
            found.slip.push_back(rubbing.slip);
            found.area.push_back(area_[q]);
            Vec3 force;  // (pressure area) n, in this order: that of the forces at nodes
            for (int k = 0; k < 3; ++k)
                force[k] = -(reaction.pressure * area_[q] * n[k] + area_[q] * reaction.tangential[k]);
            found.force.push_back(force);
        });
        for_each_far([&](int q, const Rubbing& rubbing) {
            found.friction_work += area_[q] * rubbing.work;
            found.stored += area_[q] * rubbing.stored;
        });
        found.penetration = penetration();
        found.round_off_squared = round_off.squared();
        return found;
    }

    std::vector<double> row(const Vec3& w, const Vec3& omega, const Vec3& p) override {
        std::vector<double> row(dofs(), 0.0);
        for_each_held([&](int e, int q, const Reaction& reaction) {
            const Vec3 &x = locator_.positions()[q], t = reaction.traction(locator_.normals()[q]);
            const Vec3 turned = cross(omega, {x[0] - p[0], x[1] - p[1], x[2] - p[2]}), turning = cross(t, omega);
            for (int l = 0; l < 3; ++l) {
                double value = turning[l];
                for (int k = 0; k < 3; ++k) {
                    const bool stored = !symmetric() || k <= l;
                    value -= (w[k] + turned[k]) * (stored ? reaction.K[k][l] : reaction.K[l][k]);
                }
                const std::int32_t* ids = connectivity()[e];
                for (int a = 0; a < Nodes; ++a) row[3 * ids[a] + l] += area_[q] * values_at(q)[a] * value;
            }
        });
        return row;
    }

    double round_off_squared() override {
        RoundOff round_off;
        for_each_held([&](int e, int q, const Reaction&) { round_off.add(e, weight_of_errors(q), values_at(q)); });
        return round_off.squared();
    }

    double penetration() override {
        double deepest = 0.0;
        for (int e = 0; e < connectivity().size(); ++e) {
            if (locator_.far(e)) continue;
            for (int q = e * per_facet(); q < (e + 1) * per_facet(); ++q)
                deepest = std::max(deepest, -locator_.gaps()[q]);
        }
        return deepest;
    }

    void begin() override {
        if (begun_ || !law_->follows_places()) return;
        for (int e = 0; e < connectivity().size(); ++e) leave(e);
        const std::vector<double> places = history_.trial();
        history_.restore(places.data(), places.size());
    }

    void augment(const Vec3* tractions) override {
        if (!law_->follows_places()) return;
        for_each_held([&](int e, int q, const Reaction&) {
            const Place place{locator_.gaps()[q], locator_.positions()[q], locator_.normals()[q],
                              locator_.hessians()[q], locator_.pose()};
            law_->augment(place, tractions[q], history_.state(e) + history_.size() * (q % per_facet()),
                          history_.point(q));
        });
    }

    int far_facets() const override {
        int count = 0;
        for (int e = 0; e < connectivity().size(); ++e) count += locator_.far(e) ? 1 : 0;
        return count;
    }

  private:
    using Values = std::array<double, Nodes>;
    using Reactions = std::vector<Reaction>;

    ContactBlockOf(const Connectivity& part, const std::vector<double>& X, const FacetPoints<Nodes>& facet,
                   const std::shared_ptr<const Surface>& surface, std::shared_ptr<ContactLaw> law)
        : ContactBlock(std::move(law)), locator_(part, X, facet, surface), colours_(make_colours(part)), N_(facet.N),
          scale_(part.size()) {
        area_ = facet.area;
        history_ = History(part.size(), facet.count(), law_->quantities());
    }

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

    /// Remembers where the points of a facet are that nothing holds.
    void leave(int e) {
        for (int q = 0; q < per_facet(); ++q)
            law_->leave(locator_.in_tool(e, q), history_.state(e) + history_.size() * q,
                        history_.trial(e) + history_.size() * q);
    }

    double weight_of_errors(int q) const { return law_->stiffness() * area_[q] * largest_length(q); }
    const Values& values_at(int q) const { return N_[q % per_facet()]; }

    int per_facet() const { return static_cast<int>(N_.size()); }

    double reach(int e) const { return law_->reach(per_facet(), history_.trial(e)); }

    const Locator<Nodes>& complete() {
        locator_.complete(thread_count());
        return locator_;
    }

    /// Asks the law at the points of a facet.
    void respond(int e, const double* weights, double* trial, Reaction* reactions) const {
        const std::size_t first = static_cast<std::size_t>(e) * per_facet();
        const Places places{&locator_.gaps()[first], &locator_.positions()[first], &locator_.normals()[first],
                            &locator_.hessians()[first], &locator_.pose()};
        law_->respond(per_facet(), places, weights, history_.state(e), trial, reactions);
    }

    /// Calls work(facet, point, reaction, new history) for all points of facets that are not far, in their order; the trial
    /// history stays as it is.
    template <class Work>
    void for_each_near(const Work& work) {
        locator_.settle([this](int e) { return reach(e); });
        Reactions reactions(per_facet());
        std::vector<double> trial(history_.stride());
        for (int e = 0; e < connectivity().size(); ++e) {
            if (locator_.far(e)) continue;
            std::copy_n(history_.trial(e), trial.size(), trial.begin());
            respond(e, nullptr, trial.data(), reactions.data());
            for (int q = 0; q < per_facet(); ++q)
                work(e, e * per_facet() + q, reactions[q], trial.data() + history_.size() * q);
        }
    }

    /// Calls work(point, rubbing) for all points of facets that are far, if the law follows places.
    template <class Work>
    void for_each_far(const Work& work) const {
        if (!law_->follows_places()) return;
        std::vector<double> trial(history_.stride());
        for (int e = 0; e < connectivity().size(); ++e) {
            if (!locator_.far(e)) continue;
            std::copy_n(history_.trial(e), trial.size(), trial.begin());
            for (int q = 0; q < per_facet(); ++q) {
                double* of_point = trial.data() + history_.size() * q;
                law_->leave(locator_.in_tool(e, q), history_.state(e) + history_.size() * q, of_point);
                work(e * per_facet() + q, law_->rubbing(of_point));
            }
        }
    }

    /// Calls work(facet, point, reaction) for all points that are held now, in their order.
    template <class Work>
    void for_each_held(const Work& work) {
        for_each_near([&](int e, int q, const Reaction& reaction, const double*) {
            if (reaction.held) work(e, q, reaction);
        });
    }

    void add_facet(int e, const Scatter& scatter, const Target& target, Reactions& reactions) {
        scale_[e] = 0.0;
        if (locator_.far(e)) {
            if (law_->follows_places()) leave(e);
            return;
        }
        respond(e, area_.data() + static_cast<std::size_t>(e) * per_facet(), history_.trial(e), reactions.data());
        bool active = false;
        for (const Reaction& reaction : reactions) active = active || reaction.held;
        if (!active) return;
        alignas(64) std::array<double, static_cast<std::size_t>(size) * size> K{};
        std::array<double, size> f{};
        for (int q = 0; q < per_facet(); ++q)
            if (reactions[q].held)
                add_point(reactions[q], locator_.normals()[e * per_facet() + q], N_[q], target.wants_tangent(),
                          K.data(), f.data());
        for (const double value : f) scale_[e] += value * value;
        scatter_element<Nodes>(connectivity(), scatter, e, K.data(), f.data(), target, !symmetric());
    }

    /// Of a symmetric law what is on and above the diagonal of K, and the diagonal blocks.
    void add_point(const Reaction& reaction, const Vec3& n, const Values& N, bool tangent, double* K, double* f) const {
        const Vec3 t = reaction.traction(n);
        for (int k = 0; k < 3; ++k)
            for (int a = 0; a < Nodes; ++a) f[k * Nodes + a] -= t[k] * N[a];
        if (!tangent) return;
        for (int k = 0; k < 3; ++k)
            for (int l = symmetric() ? k : 0; l < 3; ++l) {
                const double stiffness = reaction.K[k][l];
                for (int a = 0; a < Nodes; ++a)
                    for (int b = 0; b < Nodes; ++b)
                        K[(k * Nodes + a) * size + l * Nodes + b] += stiffness * N[a] * N[b];
            }
    }

    /// Length of the largest number that the gap of point q is a difference of: the position in space, that of the tool,
    /// or the distance from the centre of curvature, 1/|H|. eq. (5.35)
    double largest_length(int q) const {
        const Vec3 &x = locator_.positions()[q], &c = locator_.pose().c;
        const double place = std::sqrt(dot(x, x)) + std::sqrt(dot(c, c));
        double curvature = 0.0;
        for (const double value : locator_.hessians()[q].a) curvature += value * value;
        curvature = std::sqrt(curvature);
        return curvature * flattest * place > 1.0 ? place + 1.0 / curvature : place;
    }

    /// Radii above so many times the place of a point are those of a plane, whose H may be noise.
    static constexpr double flattest = 1e3;

    Locator<Nodes> locator_;
    std::vector<std::vector<std::int32_t>> colours_;
    std::vector<Values> N_;  // shape functions at the points of a facet
    std::vector<double> scale_;
    std::vector<Reactions> workspaces_;  // one a thread
};

}  // namespace umform
