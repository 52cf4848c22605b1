// RK4 by hand: compressed rows, one array a component, one replica. What one writes in C++ when speed
// matters; compiled with -O3 -march=native, so that the compiler may vectorise over nodes and contract
// products with sums.
#include "peer.hpp"

struct System {
    Fixture fixture;
    std::vector<double> state, slope, ahead, total;

    explicit System(Fixture from)
        : fixture(std::move(from)), state(fixture.state), slope(state), ahead(state), total(state) {}

    // dx/dt at `at`, into `slope`. Inlined into the step, g++ 12 runs out of registers in the loop over
    // k, and takes twice as long.
    __attribute__((noinline)) void flow(const std::vector<double>& at) {
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

    void advance(long steps) {
        const std::size_t size = state.size();
        const auto stage = [&](const std::vector<double>& at, double weight, double distance) {
            flow(at);
            for (std::size_t c = 0; c < size; ++c) {
                total[c] += weight * slope[c];
                ahead[c] = state[c] + distance * slope[c];
            }
        };
        for (long step = 0; step < steps; ++step) {
            total = state;
            stage(state, STEP / 6, STEP / 2);
            stage(ahead, STEP / 3, STEP / 2);
            stage(ahead, STEP / 3, STEP);
            stage(ahead, STEP / 6, 0.0);
            state.swap(total);
        }
    }
};

int main(int argc, char** argv) {
    return run<System>("C++ RK4 (" COMPILER ")", argc, argv);
}
