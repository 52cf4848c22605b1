// Boost.Odeint's runge_kutta4 on std::vector<double>, one replica, as in its tutorial; the right-hand
// side is that of `cpp_rk4.cpp`, and so are the compiler's options.
#include "peer.hpp"

#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <boost/version.hpp>

using State = std::vector<double>;

struct Network {
    const Fixture& fixture;

    __attribute__((noinline)) void operator()(const State& at, State& slope, double) const {
        const int n = fixture.n_nodes;
        const int* starts = fixture.starts.data();
        const int* columns = fixture.columns.data();
        const double* weights = fixture.weights.data();
        const double *x = at.data(), *y = x + n, *z = y + n;
        double *dx = slope.data(), *dy = dx + n, *dz = dy + n;
        for (int i = 0; i < n; ++i) {
            double input = 0.0;
            for (int k = starts[i]; k < starts[i + 1]; ++k) input += weights[k] * x[columns[k]];
            const double x2 = x[i] * x[i];
            dx[i] = y[i] + x2 * (3.0 - x[i]) - z[i] + CURRENT + fixture.epsilon * input;
            dy[i] = 1.0 - 5.0 * x2 - y[i];
            dz[i] = RATE * (STRENGTH * (x[i] + 1.6) - z[i]);
        }
    }
};

struct System {
    Fixture fixture;
    State state;
    boost::numeric::odeint::runge_kutta4<State> stepper;

    explicit System(Fixture from) : fixture(std::move(from)), state(fixture.state) {}

    void advance(long steps) {
        for (long step = 0; step < steps; ++step)
            stepper.do_step(Network{fixture}, state, 0.0, STEP);
    }
};

int main(int argc, char** argv) {
    const int version = BOOST_VERSION;
    const std::string name = "Boost.Odeint " + std::to_string(version / 100000) + "." +
                             std::to_string(version / 100 % 1000) + " runge_kutta4";
    return run<System>(name + " (" COMPILER ")", argc, argv);
}
