#include "tree_search.hpp"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <memory>
#include <takt/core/random.hpp>

namespace takt::planner::roadmap {

namespace {

namespace ob = ompl::base;

const double* valuesOf(const ob::State* state) {
    return state->as<ob::RealVectorStateSpace::StateType>()->values;
}
double* valuesOf(ob::State* state) {
    return state->as<ob::RealVectorStateSpace::StateType>()->values;
}

/// The axes, measured by the metric of the problem.
class AxisSpace final : public ob::RealVectorStateSpace {
public:
    explicit AxisSpace(const SearchProblem& problem)
        : RealVectorStateSpace{static_cast<unsigned>(problem.metric.axes())},
          metric_{&problem.metric} {
        ob::RealVectorBounds bounds{dimension_};
        std::copy(problem.low.begin(), problem.low.end(), bounds.low.begin());
        std::copy(problem.high.begin(), problem.high.end(), bounds.high.begin());
        setBounds(bounds);
    }

    double distance(const ob::State* a, const ob::State* b) const override {
        return metric_->distance(valuesOf(a), valuesOf(b));
    }

private:
    const Metric* metric_;
};

/// Takes every number from our own generator: the library's seeds one for the whole process, so
/// that a second plan would see other numbers than the first.
class SeededSampler final : public ob::StateSampler {
public:
    SeededSampler(const ob::StateSpace* space, const SearchProblem& problem,
                  const SearchTry& attempt)
        : StateSampler{space},
          problem_{problem},
          knownLength_{attempt.knownLength},
          random_{attempt.seed} {}

    void sampleUniform(ob::State* state) override {
        constexpr int Tries = 100;
        double* const values = valuesOf(state);
        for (int i = 0; i < Tries; ++i) {
            draw(values, [this](std::size_t axis) {
                return random_.uniform(problem_.low[axis], problem_.high[axis]);
            });
            const Metric& metric = problem_.metric;
            const double way = metric.distance(problem_.start.data(), values) +
                               metric.distance(values, problem_.goal.data());
            if (way < knownLength_) return;
        }
    }

    void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
        const double* const centre = valuesOf(near);
        draw(valuesOf(state), [&](std::size_t axis) {
            const double reach = distance / problem_.metric.factor(axis);
            return random_.uniform(centre[axis] - reach, centre[axis] + reach);
        });
    }

    void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
        constexpr int Terms = 12;  // uniform numbers whose sum has the variance 1
        const double* const centre = valuesOf(mean);
        draw(valuesOf(state), [&](std::size_t axis) {
            double sum = 0.0;
            for (int i = 0; i < Terms; ++i) sum += random_.uniform(-0.5, 0.5);
            return centre[axis] + sum * deviation / problem_.metric.factor(axis);
        });
    }

private:
    template <typename Draw>
    void draw(double* values, const Draw& next) {
        for (std::size_t axis = 0; axis < problem_.metric.axes(); ++axis) {
            const bool counts = problem_.metric.factor(axis) > 0.0;
            values[axis] = counts ? std::clamp(next(axis), problem_.low[axis], problem_.high[axis])
                                  : problem_.start[axis];
        }
    }

    SearchProblem problem_;
    double knownLength_;
    core::Random random_;
};

/// Straight motions against the keep-outs, exactly.
class SegmentValidator final : public ob::MotionValidator {
public:
    SegmentValidator(const ob::SpaceInformationPtr& information, const SearchProblem& problem)
        : MotionValidator{information}, problem_{problem} {}

    bool checkMotion(const ob::State* from, const ob::State* to) const override {
        const std::size_t axes = problem_.metric.axes();
        const bool free =
            problem_.obstacles.isFree(Point{valuesOf(from), axes}, Point{valuesOf(to), axes});
        ++(free ? valid_ : invalid_);
        return free;
    }

    bool checkMotion(const ob::State* from, const ob::State* to,
                     std::pair<ob::State*, double>& lastValid) const override {
        if (checkMotion(from, to)) return true;
        if (lastValid.first != nullptr) si_->copyState(lastValid.first, from);
        lastValid.second = 0.0;
        return false;
    }

private:
    SearchProblem problem_;
};

ob::SpaceInformationPtr makeInformation(const SearchProblem& problem, const SearchTry& attempt) {
    const auto space = std::make_shared<AxisSpace>(problem);
    space->setStateSamplerAllocator([problem, attempt](const ob::StateSpace* owner) {
        return std::make_shared<SeededSampler>(owner, problem, attempt);
    });
    auto information = std::make_shared<ob::SpaceInformation>(space);
    information->setStateValidityChecker([problem](const ob::State* state) {
        return !problem.obstacles.around(Point{valuesOf(state), problem.metric.axes()});
    });
    information->setMotionValidator(std::make_shared<SegmentValidator>(information, problem));
    information->setup();
    return information;
}

ob::ProblemDefinitionPtr makeDefinition(const ob::SpaceInformationPtr& information,
                                        const SearchProblem& problem) {
    ob::ScopedState<> start{information};
    ob::ScopedState<> goal{information};
    std::copy(problem.start.begin(), problem.start.end(), valuesOf(start.get()));
    std::copy(problem.goal.begin(), problem.goal.end(), valuesOf(goal.get()));
    auto definition = std::make_shared<ob::ProblemDefinition>(information);
    definition->setStartAndGoalStates(start, goal);
    return definition;
}

Polyline lineOf(const ob::ProblemDefinition& definition, std::size_t axes) {
    const auto path =
        std::dynamic_pointer_cast<ompl::geometric::PathGeometric>(definition.getSolutionPath());
    Polyline line;
    for (const ob::State* state : path->getStates()) {
        const double* const values = valuesOf(state);
        line.emplace_back(values, values + axes);
    }
    return line;
}

}  // namespace

SearchResult searchTree(const SearchProblem& problem, const SearchTry& attempt) {
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    const ob::SpaceInformationPtr information = makeInformation(problem, attempt);
    const ob::ProblemDefinitionPtr definition = makeDefinition(information, problem);
    ompl::geometric::RRTConnect planner{information};
    // The library's other structures draw numbers of their own.
    planner.setNearestNeighbors<ompl::NearestNeighborsLinear>();
    planner.setRange(attempt.range);
    planner.setProblemDefinition(definition);
    planner.setup();
    SearchResult result;
    const ob::PlannerTerminationCondition done{[&result, &attempt] {
        if (result.iterations >= attempt.iterations) return true;
        ++result.iterations;
        return false;
    }};
    const ob::PlannerStatus status = planner.solve(done);
    if (status == ob::PlannerStatus::EXACT_SOLUTION)
        result.line = lineOf(*definition, problem.metric.axes());
    return result;
}

}  // namespace takt::planner::roadmap
