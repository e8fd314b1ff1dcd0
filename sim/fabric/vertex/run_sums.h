#pragma once

#include <vector>

namespace sim {

/// Adds up products of rows that follow each other, run by run; a run is all added by one of these.
class RunSums {
 public:
    explicit RunSums(std::vector<double>& ofRun) : ofRun_(ofRun) {}
    ~RunSums() { close(); }
    RunSums(const RunSums&) = delete;
    RunSums& operator=(const RunSums&) = delete;
    void add(int run, double product)
    {
        if (run != run_) close();
        run_ = run;
        sum_ += product;
    }

 private:
    void close()
    {
        if (run_ >= 0) ofRun_[run_] = sum_;
        sum_ = 0.0;
    }

    std::vector<double>& ofRun_;
    int run_ = -1;
    double sum_ = 0.0;
};

}  // namespace sim
