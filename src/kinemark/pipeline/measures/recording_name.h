// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Who was recorded, when, in which trial: what tells the rows of many recordings apart.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/text/tidy_csv.h"

namespace kinemark::pipeline {

/// What the rows of a span say of it besides: conditions of trials.
struct SpanLabels {
  std::vector<std::string> columns;                       ///< names, unique
  std::map<std::string, std::vector<std::string>> cells;  ///< of each span by its name, one a column
};

/// What every row of a table says of its recording. Texts are empty where nobody tells them.
struct RecordingName {
  std::string file;         ///< name of the file
  std::string participant;  ///< "sub-01"
  std::string session;      ///< "ses-2"
  std::string trial;        ///< "task-walk_run-1"; of other names the file's without its ending
  std::vector<std::pair<std::string, std::string>> more;  ///< column and value, of the participants' table
  SpanLabels spans;                                       ///< of its trials

  /// The three texts that tell recordings apart, with a blank between them.
  [[nodiscard]] std::string key() const { return participant + " " + session + " " + file; }
};

/// By the path alone. A name of BIDS (sub-LABEL[_ses-LABEL][_KEY-LABEL ...][_SUFFIX]) tells participant,
/// session and trial; where it tells none, folders called sub-LABEL and ses-LABEL do.
[[nodiscard]] RecordingName name_of_recording(const std::filesystem::path& path);

/// A table of participants, as BIDS has it, or of files.
struct Participants {
  io::TidyTable table;             ///< as read
  std::int64_t file = -1;          ///< column that names files; -1: there is none
  std::int64_t participant = -1;   ///< column of who was recorded; -1: there is none
  std::int64_t session = -1;       ///< column of when; -1: there is none
  std::int64_t trial = -1;         ///< column of which trial; -1: there is none
  std::vector<std::int64_t> more;  ///< columns that are passed on
};

/// Read a table whose column `participant_id` (or `participant`) names who; beside it may be `session_id`
/// (`session`) and `trial`, or `file`: then a row is of that file, and names its participant. Other columns
/// are passed on, under "participant_NAME" where the tables of measures, events or cycles have a column of
/// that name. Code::bad_input without a column that names participants or files, and where two rows are of
/// the same.
[[nodiscard]] Result<Participants> read_participants(const std::filesystem::path& path);

/// What the table says of a recording: its participant, session and trial where it names files, and all
/// columns that are passed on; "n/a" is empty. Every recording gets all columns.
/// @return  whether the table has a row for it
bool take_participant(const Participants& participants, RecordingName& name);

/// Files and folders given, as files; of a folder with folders sub-LABEL in it (a data set of BIDS) the
/// recordings in those, however deep. Errors and notes as list_inputs().
struct Recordings {
  std::vector<std::filesystem::path> files;  ///< in the order given, those of a folder by name
  std::vector<std::string> notes;            ///< what was passed over
};
/// The same; Code::usage for two that nothing tells apart: one name, participant and session.
[[nodiscard]] Result<Recordings> list_recordings(const std::vector<std::filesystem::path>& given);

/// "file,participant,session,trial": the columns that begin every table.
[[nodiscard]] std::string name_columns();
/// Their cells, with commas between.
[[nodiscard]] std::string name_cells(const RecordingName& name);
/// ",age,sex": names of the columns that end every table; empty without any.
[[nodiscard]] std::string more_columns(const RecordingName& name);
/// Their cells, a comma before each.
[[nodiscard]] std::string more_cells(const RecordingName& name);
/// ",side,target": what a table of spans says of each, behind; empty without any.
[[nodiscard]] std::string span_columns(const RecordingName& name);
/// The cells of a span, a comma before each; empty ones of a span that nothing is said of.
[[nodiscard]] std::string span_cells(const RecordingName& name, const std::string& span);
/// The cell of one column, by its number.
[[nodiscard]] std::string span_cell(const RecordingName& name, const std::string& span, std::size_t column);
/// Give all recordings of a table the same columns of spans, in the order in which they come.
void unite_span_columns(const std::vector<RecordingName*>& names);
/// Columns that a table has already get the prefix "span_".
void name_apart(SpanLabels& labels, std::string_view table_columns);

}  // namespace kinemark::pipeline
