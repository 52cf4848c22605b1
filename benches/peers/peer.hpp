// What the C++ peers share: the fixture file, the timing, and what is handed back. As `peer.py`,
// called as `PEER FIXTURE REPLICAS SECONDS REPEATS CHECK`; these advance one replica at a time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

constexpr double STEP = 0.01, RATE = 0.006, STRENGTH = 4.0, CURRENT = 3.2;

struct Fixture {
    int n_nodes;
    std::vector<int> starts, columns; // W in compressed rows
    std::vector<double> weights;
    double epsilon;            // of the first replica
    std::vector<double> state; // of the first replica, [component][node]
};

template <class Number> std::vector<Number> numbers(std::istream& file, std::size_t count) {
    std::vector<Number> all(count);
    for (auto& number : all) file >> number;
    return all;
}

inline Fixture read(const char* path) {
    std::ifstream file(path);
    Fixture fixture;
    std::size_t n_entries = 0, n_replicas = 0;
    file >> fixture.n_nodes >> n_entries >> n_replicas;
    fixture.starts = numbers<int>(file, fixture.n_nodes + 1);
    fixture.columns = numbers<int>(file, n_entries);
    fixture.weights = numbers<double>(file, n_entries);
    fixture.epsilon = numbers<double>(file, n_replicas).at(0);
    fixture.state = numbers<double>(file, 3 * fixture.n_nodes);
    if (!file) {
        std::fprintf(stderr, "%s is no fixture\n", path);
        std::exit(1);
    }
    return fixture;
}

inline double processor_time() {
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return now.tv_sec + 1e-9 * now.tv_nsec;
}

// Checks and times `system.advance(steps)` with `system.state`, [component][node].
template <class System> int run(const std::string& name, int argc, char** argv) {
    if (argc != 6 || std::atoi(argv[2]) != 1) {
        std::fprintf(stderr, "this peer advances one replica at a time\n");
        return 1;
    }
    System system(read(argv[1]));
    const double seconds = std::atof(argv[3]);
    const int repeats = std::atoi(argv[4]), n_nodes = system.fixture.n_nodes;
    const auto timed = [&](long steps) {
        const double started = processor_time();
        system.advance(steps);
        return processor_time() - started;
    };

    timed(std::lround(1.0 / STEP));
    std::ofstream check(argv[5]);
    check.precision(17);
    for (int i = 0; i < n_nodes; ++i) check << system.state[i] << ' ';
    check << '\n';

    long steps = 100;
    double best = timed(steps);
    while (best < seconds) {
        steps *= 2;
        best = timed(steps);
    }
    for (int repeat = 1; repeat < repeats; ++repeat) best = std::min(best, timed(steps));
    if (!std::isfinite(system.state[0])) {
        std::fprintf(stderr, "the states are no longer numbers\n");
        return 1;
    }
    std::printf("{\"name\": \"%s\", \"node_steps_per_s\": %.17g, \"seconds_to_start\": 0.0}\n",
                name.c_str(), double(n_nodes) * double(steps) / best);
    return 0;
}
