#pragma once

#include "pipeline/atmosphere_deck.h"

/// What atmosphere_deck.cpp puts together: the input files of each code.
namespace pyroscene::pipeline {

using DeckFiles = std::vector<std::pair<std::string, std::string>>;  ///< {file name, text}

constexpr double kDeckTop_km = 99.9;    ///< MODTRAN's atmosphere ends at 100 km
constexpr double kDeckCo2_ppm = 420.0;  ///< that of the 2020s; the codes' own profiles have 330 to 400

/// Number of a model atmosphere in LOWTRAN, MODTRAN and libRadtran; mid-latitude summer for unknown ones.
int deck_model_number(const std::string& model);

DeckFiles modtran6_files(const DeckGeometry& geometry, const std::vector<DeckRun>& runs);
/// Cards 1, 1A, 2, 3, 3A1, 3A2, 4 and 5 of MODTRAN 5, one set per run; card 5 asks for the next one.
DeckFiles modtran5_files(const DeckGeometry& geometry, const std::vector<DeckRun>& runs);
DeckFiles libradtran_files(const DeckGeometry& geometry);

}  // namespace pyroscene::pipeline
