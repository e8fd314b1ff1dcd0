#pragma once

namespace sim::contact {

/// Token that a CandidateList holds all pairs which moves bring near, until it covers others.
class CoveredMoves {
 public:
    bool wereSearched() const { return wereSearched_; }

 private:
    friend class CandidateList;
    explicit CoveredMoves(bool wereSearched) : wereSearched_(wereSearched) {}
    bool wereSearched_;
};

}  // namespace sim::contact
