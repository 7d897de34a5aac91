// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Made by `npm run schema` from viewer/schema; change that.

/** One of these, by `summary.schema` and `summary.kind`. */
export type Page = IkPage | CleanPage | MarkersPage | LivePage | DeskPage | TrialsPage | FactsPage | NoticePage | ResultPage;

/** The page: summary, curves, cycles, space. */
export interface IkPage {
  /** What `Q_report.json` holds. */ summary: IkSummary;
  /** Curves of the plots. */ series: IkSeries;
  /** Coordinates over cycles; null: no events mark two strikes of a foot. */ cycles: EncodedCycles | null;
  /** Space; null: positions are not known, or not in the model's axes. Without markers its points are sensors, in the middle of their bodies. */ scene: PackedScene | null;
  /** Inertial sensors, in place of markers or beside them; null: none. */ sensors?: IkSensors | null;
}

/** Inertial sensors that the angles follow. */
export interface IkSensors {
  /** Turn of the sensors' world about the vertical, deg. */ heading_deg: number | null;
  /** Its standard deviation, deg; 0: given. */ heading_sd_deg: number | null;
  /** What it follows from: `motion`, `markers`, `facing axis`, or `model`: none is needed. */ heading_from: string;
  /** Largest turn of a sensor within the pose that places it, deg. */ pose_drift_deg: number | null;
  /** Standard deviation of an orientation about each axis, deg; null: not known. */ noise_sd_deg: number | null;
  /** RMS angle between sensors and model, deg. */ rms_deg: number | null;
  /** Largest of these angles, deg. */ max_deg: number | null;
  /** One per sensor used. */ rows: SensorSummary[];
}

/** One inertial sensor. */
export interface SensorSummary {
  /** In the recording. */ name: string;
  /** Of the model, that carries it. */ body: string;
  /** What says how it stands there: `pose`, `model` or `markers`. */ placed_by: string;
  /** Frames with an orientation that was used. */ seen_frames: number;
  /** Samples that were left out. */ rejected_samples: number;
  /** RMS angle between measured and model, deg. */ rms_deg: number | null;
  /** Largest such angle, deg. */ max_deg: number | null;
  /** When that was, s. */ max_time_s: number | null;
}

/** `Q_report.json`; a page holds the same, without the set. */
export interface IkSummary {
  /** Digest that the files of one run share, 16 hexadecimal digits; in the file alone. */ kinemark_set?: string;
  /** Checksum of the file, 16 hexadecimal digits; in the file alone. */ kinemark_sum?: string;
  /** Which report this is. */ schema: "kinemark.ik_report";
  /** It counts up when a member changes its meaning or goes away. Version 1 counted frames from 0. */ schema_version: 2;
  /** Name of the recording for people. */ trial: string;
  /** The model's own name. */ model: string;
  /** `least squares` or `direct marker control`. */ method: string;
  /** `attention`: look before use. */ verdict: Verdict;
  /** Of the program: 0 good, 1 missed a gate. */ exit_status: number;
  /** Frames of the motion, F. */ frames: number;
  /** Frame rate, Hz. */ rate_hz: number;
  /** Time of frame 0, s: frame i is at `first_time_s + i / rate_hz`. */ first_time_s: number;
  /** What the recording's file calls frame 0. */ first_frame: number;
  /** Wall clock of the solve alone, s. */ solve_s: number | null;
  /** Frames solved a second. */ frames_per_s: number | null;
  /** As asked for. */ threads: number;
  /** Seed of everything random. */ seed: number;
  /** Version of the program. */ version: string;
  /** The command as given. */ command_line: string;
  /** RMS distance of measured and model marker, over all frames and seen markers, mm. */ rms_error_mm: number | null;
  /** Largest of these distances, mm. */ max_error_mm: number | null;
  /** Share of frames x coordinates that the visible markers fix, 0 to 1; locked coordinates do not count. */ determined_fraction: number | null;
  /** Frames by how they ended. */ status_frames: StatusFrames;
  /** Samples that were left out. */ rejected_samples: number;
  /** The same as a share of all samples, 0 to 1; null: samples were not judged. */ rejected_fraction: number | null;
  /** Every span left out. */ rejected: RejectedSpan[];
  /** Markers whose labels were exchanged back. */ exchanged: ExchangedLabels[];
  /** What to look at, problems first. */ findings: Finding[];
  /** Quality checks. */ gates: Gate[];
  /** Mass of the model's bodies together, kg. */ mass_kg: number | null;
  /** One per coordinate of the model, in its order. */ coordinates: CoordinateSummary[];
  /** Markers used, in the motion's order, then those left out. */ markers: MarkerSummary[];
  /** Largest RMS error first, at least 0.25 s apart. */ worst_frames: WorstFrame[];
  /** Every option in force, as text. */ options: Record<string, string>;
  /** Files read. */ inputs: InputFile[];
  /** Irregularities, one sentence each. */ warnings: string[];
}

/** How a frame ended. */
export type FrameStatus = "converged" | "not_converged" | "underdetermined" | "no_markers";

/** Number of frames by status. */
export interface StatusFrames {
  /** All is determined. */ converged: number;
  /** The solver stopped before. */ not_converged: number;
  /** Markers do not fix every coordinate. */ underdetermined: number;
  /** No marker was seen. */ no_markers: number;
}

/** Samples of a marker that were left out; both ends included. */
export interface RejectedSpan {
  /** Its name. */ marker: string;
  /** First frame. */ first_frame: number;
  /** Last frame. */ last_frame: number;
  /** Time of the first, s. */ first_time_s: number | null;
  /** Time of the last, s. */ last_time_s: number | null;
  /** From where the model and the frames beside expect it, mm. */ distance_mm: number | null;
  /** Reason in a few words; empty: the distance alone. */ why: string;
}

/** Two markers that carried each other's label. */
export interface ExchangedLabels {
  /** One of them. */ marker: string;
  /** The other. */ other: string;
  /** As in edits: `1-127/3`, every third from 1 to 127. */ frames: string;
  /** How many frames. */ count: number;
  /** Median distance of the two, mm. */ apart_mm: number | null;
}

/** One coordinate over the recording. */
export interface CoordinateSummary {
  /** In the model. */ name: string;
  /** Unit of this report and its page. */ unit: "deg" | "m";
  /** Unit in `Q.mot` and the tables beside it: OpenSim keeps some in rad. */ unit_in_tables: "deg" | "rad" | "m";
  /** True: the model or the user holds it. */ locked: boolean;
  /** Frames in which the markers fix it. */ determined_frames: number;
  /** Frames in which no visible marker fixes it; null: not known. */ open_frames: number | null;
  /** Smallest value over determined frames. */ min: number | null;
  /** Largest value over determined frames. */ max: number | null;
  /** Median standard deviation over determined frames. */ median_sd: number | null;
  /** Range of the model; null: none. */ limits: [number, number] | null;
  /** Determined frames at a limit or beyond. */ at_limit_frames: number;
}

/** One marker, used or not. */
export interface MarkerSummary {
  /** In the model, or in the recording. */ name: string;
  /** False: it took no part. */ used: boolean;
  /** A few words; empty when used. */ why_excluded: string;
  /** As given. */ weight: number | null;
  /** Frames with an error, or with coordinates for a marker left out. */ seen_frames: number;
  /** Frames in which its sample was left out. */ rejected_frames: number;
  /** RMS distance from the model's marker, mm. */ rms_error_mm: number | null;
  /** Largest distance, mm. */ max_error_mm: number | null;
  /** When that was, s. */ max_error_time_s: number | null;
  /** Standard deviation along one axis, mm, given or estimated. */ noise_sd_mm: number | null;
}

/** A frame that fits badly. */
export interface WorstFrame {
  /** Its number. */ frame: number;
  /** Its time, s. */ time_s: number;
  /** Over the markers seen in it, mm. */ rms_error_mm: number | null;
  /** How many. */ markers_seen: number;
  /** The one farthest off. */ worst_marker: string;
  /** Its distance, mm. */ worst_marker_error_mm: number | null;
  /** How the frame ended. */ status: FrameStatus;
}

/** Curves of P points; point p is at `first_time_s + p * frame_step / rate_hz`. */
export interface IkSeries {
  /** Frames a point. */ frame_step: number;
  /** P. */ points: number;
  /** One per coordinate. */ coordinates: CoordinateCurve[];
  /** One per coordinate, N m or N; null: none. Empty where torques were not computed. */ torques: (CurveWithSd | null)[];
  /** RMS over the markers seen; missing where none is. */ rms_error_mm: PackedCurve;
  /** One per used marker, in the order of the summary; missing where it is not seen. */ marker_error_mm: PackedCurve[];
  /** One per marker of the summary: 0 measured, 1 filled, 2 missing, 3 rejected; null: not known. */ gaps: (PackedCodes | null)[];
  /** 0 converged, 1 underdetermined, 2 not converged, 3 no markers. */ status: PackedCodes;
  /** One per sensor, in the order of `sensors`; absent without any. Missing where it is not used. */ sensor_error_deg?: PackedCurve[];
  /** RMS over the sensors used; absent without any. */ sensor_rms_deg?: PackedCurve;
  /** One per sensor: 0 measured, 2 missing, 3 rejected; absent without any. */ sensor_gaps?: PackedCodes[];
}

/** A coordinate, deg or m; missing where it is not determined. */
export interface CoordinateCurve {
  /** Its value. */ value: PackedCurve;
  /** One standard deviation; null: not known. */ sd: PackedCurve | null;
  /** 1 where a frame of the point is not determined; null: all are. */ undetermined: PackedCodes | null;
}

/** The page: summary, curves, space. */
export interface CleanPage {
  /** What the report file holds; of gaps and defects the 3,000 longest. */ summary: CleanSummary;
  /** Curves of the plots. */ series: CleanSeries;
  /** The result in evenly chosen frames as they are (250 kB); null where points of the curves are frames: the page takes space from them. */ scene: PackedScene | null;
}

/** The report file; a page holds the same, without the set. */
export interface CleanSummary {
  /** Digest that the files of one run share, 16 hexadecimal digits; in the file alone. */ kinemark_set?: string;
  /** Checksum of the file, 16 hexadecimal digits; in the file alone. */ kinemark_sum?: string;
  /** Which report this is. */ schema: "kinemark.clean_report";
  /** It counts up when a member changes its meaning or goes away. */ schema_version: 2;
  /** Name of the recording for people. */ trial: string;
  /** As asked for. */ gap_method: string;
  /** As asked for. */ filter_method: string;
  /** `attention`: look before use. */ verdict: Verdict;
  /** Of the program. */ exit_status: number;
  /** Frames of the result. */ frames: number;
  /** Frame rate, Hz. */ rate_hz: number;
  /** Time of frame 0, s: frame i is at `first_time_s + i / rate_hz`. */ first_time_s: number;
  /** What the recording's file calls frame 0. */ first_frame: number;
  /** Wall clock without reading and writing, s. */ clean_s: number | null;
  /** As asked for. */ threads: number;
  /** Seed of everything random. */ seed: number;
  /** Version of the program. */ version: string;
  /** The command as given. */ command_line: string;
  /** Samples by state as they came in, all markers together. */ before: StateCounts;
  /** The same of the result. */ after: StateCounts;
  /** What to look at, problems first. */ findings: Finding[];
  /** Quality checks. */ gates: Gate[];
  /** What the recorder did to its stream. */ upsampling: Upsampling;
  /** One per marker. */ markers: CleanMarker[];
  /** Gaps, those that a page does not list included. */ gap_count: number;
  /** Gaps. */ gaps: CleanGap[];
  /** Defects, those that a page does not list included. */ defect_count: number;
  /** Defects. */ defects: CleanDefect[];
  /** Every option in force, as text. */ options: Record<string, string>;
  /** Files read. */ inputs: InputFile[];
  /** Irregularities, one sentence each. */ warnings: string[];
}

/** Samples that the recorder made. */
export interface Upsampling {
  /** False: the stream was not looked at. */ looked: boolean;
  /** Frames made of one; 1: none found. */ factor: number;
  /** What was done about it. */ done: string;
  /** True: it was dealt with. */ handled: boolean;
  /** What was found, one sentence each. */ sentences: string[];
}

/** What was done to a marker. */
export interface CleanMarker {
  /** Its name. */ name: string;
  /** Samples by state as they came in. */ before: StateCounts;
  /** The same of the result. */ after: StateCounts;
  /** Gaps filled. */ gaps_filled: number;
  /** Gaps left open. */ gaps_open: number;
  /** The longest left open, s; 0: none. */ longest_open_s: number;
  /** Largest standard deviation of a filled sample, mm; null: none. */ largest_fill_sd_mm: number | null;
  /** Filter; empty: none. */ method: string;
  /** Order of the filter. */ order: number;
  /** -3 dB of the whole of it, Hz. */ cutoff_hz: number | null;
  /** Standard deviation of the noise along one axis, mm. */ noise_sd_mm: number | null;
  /** `given`, `covariance`, `data` or empty. */ noise_from: string;
  /** Why this filter, in a sentence. */ words: string;
  /** Name of the criterion with its unit. */ criterion: string;
  /** Filters compared. */ tried: TriedFilter[];
  /** RMS of what the filter took away, along one axis, mm. */ residual_rms_mm: number | null;
  /** Of the residual at lags of 1, 2, ... frames. */ autocorrelation: (number | null)[];
  /** The same as this filter makes of white noise. */ autocorrelation_if_white: (number | null)[];
  /** True: the noise is white; null: not judged. */ white: boolean | null;
  /** p of Bartlett's test. */ white_p: number | null;
  /** Share of the noise power at other frequencies; below 0: too high ones. */ white_departure: number | null;
  /** Factors on the standard deviations of position, velocity, acceleration, jerk. */ bar_scale: (number | null)[];
  /** The same in gaps. */ gap_bar_scale: (number | null)[];
  /** Samples whose variance could not be used. */ bad_variances: number;
  /** Frames that the recorder made of one; 1: none found. */ upsampling_factor: number;
  /** How it made them; empty: none found. */ upsampling_kernel: string;
  /** Verdict on the band that the recorder kept; empty: not looked at. */ band: string;
  /** Power, summed over the axes. */ spectrum: Spectrum;
}

/** A filter that was compared. */
export interface TriedFilter {
  /** Its order. */ order: number;
  /** Its cut-off, Hz. */ cutoff_hz: number | null;
  /** The smaller the better; its unit is in the name. */ criterion: number | null;
}

/** Power by frequency; K values each. */
export interface Spectrum {
  /** K. */ frequency_hz: (number | null)[];
  /** K: as it came in, mm^2/Hz. */ raw_mm2_per_hz: (number | null)[];
  /** K: of what was taken away, mm^2/Hz. */ residual_mm2_per_hz: (number | null)[];
}

/** A gap; both ends belong to it. */
export interface CleanGap {
  /** Whose. */ marker: string;
  /** First frame. */ first_frame: number;
  /** Last frame. */ last_frame: number;
  /** Time of the first, s. */ first_time_s: number;
  /** Time of the last, s. */ last_time_s: number;
  /** Frames over rate, s. */ length_s: number;
  /** True: at the start or end of the recording. */ at_edge: boolean;
  /** False: left open. */ filled: boolean;
  /** Method that filled it. */ method: string;
  /** The same in words. */ how: string;
  /** Methods that were joined. */ weights: GapWeight[];
  /** Standard deviation along one axis, RMS over the gap, mm. */ sd_mm: number | null;
  /** Largest of the gap, mm. */ max_sd_mm: number | null;
  /** Artificial gaps that these come from. */ windows: number;
  /** Their length, s. */ window_s: number | null;
  /** Markers it was filled from. */ predictors: string[];
  /** Markers that were not used. */ dropped: string[];
  /** Reason; empty when filled. */ why_open: string;
}

/** A method's part in a filled gap. */
export interface GapWeight {
  /** The method. */ name: string;
  /** Its weight, 0 to 1. */ weight: number | null;
  /** Its RMS error on artificial gaps, mm. */ rms_mm: number | null;
  /** True: its weight was held down. */ guarded: boolean;
}

/** A defect of the recording. */
export interface CleanDefect {
  /** `spike`, `label_swap`, `stuck`, ... */ kind: string;
  /** Whose; empty: all. */ marker: string;
  /** The other of a swap; else empty. */ other_marker: string;
  /** First frame. */ first_frame: number;
  /** Last frame. */ last_frame: number;
  /** Time of the first, s. */ first_time_s: number;
  /** Time of the last, s. */ last_time_s: number;
  /** 0 to 1; null: not known. */ confidence: number | null;
  /** The defect in words. */ sentence: string;
  /** What was done about it. */ done: string;
  /** False: left as it was. */ handled: boolean;
}

/** Curves of P points; point p is at `first_time_s + p * frame_step / rate_hz`. */
export interface CleanSeries {
  /** Frames a point. */ frame_step: number;
  /** P. */ points: number;
  /** One per marker. */ markers: EncodedMarker[];
}

/** Curves of a marker. */
export interface EncodedMarker {
  /** As it came in, mm; `sum`: position and change together. */ raw_mm: [PackedCurve | Sum | null, PackedCurve | Sum | null, PackedCurve | Sum | null];
  /** The result, mm. */ position_mm: EncodedAxes;
  /** Its standard deviation, mm. */ position_sd_mm: EncodedAxes;
  /** As it came in less the result, mm. */ change_mm: EncodedAxes;
  /** m/s. */ velocity: EncodedAxes;
  /** Its standard deviation, m/s. */ velocity_sd: EncodedAxes;
  /** m/s^2. */ acceleration: EncodedAxes;
  /** Its standard deviation, m/s^2. */ acceleration_sd: EncodedAxes;
  /** States as they came in: 0 measured, 1 upsampled, 2 interpolated, 3 model_filled, 4 missing, 5 rejected. */ before: PackedCodes;
  /** The same of the result. */ after: PackedCodes;
}

/** The page: summary, space, edits. */
export interface MarkersPage {
  /** The recording. */ summary: MarkersSummary;
  /** Space. */ scene: PackedScene;
  /** Spikes, trials and field potentials on the recording's clock; absent: the file has none. */ neural?: NeuralLanes;
  /** Edits, of a page of `kinemark serve` alone. */ editing?: Editing;
}

/** What lies beside the movement. */
export interface NeuralLanes {
  /** Where the first bin of spikes begins, s. */ start_s: number;
  /** Length of a bin, s. */ bin_s: number;
  /** Bins, 3,001 at most. */ bins: number;
  /** Units in the file. */ unit_count: number;
  /** The first 500 of them. */ units: UnitLane[];
  /** Those that touch the recording, 2,000 at most. */ trials: TrialLane[];
  /** Series of field potentials. */ fields: FieldLane[];
}

/** Spikes of a unit. */
export interface UnitLane {
  /** Of the unit. */ id: string;
  /** In the recording. */ spikes: number;
  /** Spikes in each bin, 255 at most. */ counts: PackedCodes;
}

/** A trial. */
export interface TrialLane {
  /** Its conditions; may be empty. */ label: string;
  /** Its start, s. */ start_s: number;
  /** Its end, s. */ stop_s: number;
}

/** The least and the largest values of field potentials in bins. */
export interface FieldLane {
  /** Of the series. */ name: string;
  /** Of the values. */ unit: string;
  /** Where its first bin begins, s. */ start_s: number;
  /** Length of a bin, s. */ bin_s: number;
  /** Bins, 1,500 at most. */ bins: number;
  /** Its channels, 16 at most. */ channels: FieldChannel[];
}

/** A channel: code c is the value `least + step * c`; 255: no sample. */
export interface FieldChannel {
  /** Its name. */ name: string;
  /** Its least value, in the unit of the series. */ least: number;
  /** What codes are multiples of. */ step: number;
  /** Least values of the bins, rounded down. */ low: PackedCodes;
  /** Largest values, rounded up. */ high: PackedCodes;
}

/** A recording in numbers. */
export interface MarkersSummary {
  /** Which page this is. */ schema: "kinemark.markers_report";
  /** Its version. */ schema_version: 1;
  /** Name of the recording for people. */ trial: string;
  /** Format of the file. */ format: string;
  /** Unit of lengths in the file. */ units: string;
  /** Who wrote it; may be empty. */ software: string;
  /** `attention`: look before use. */ verdict: Verdict;
  /** Frames. */ frames: number;
  /** Frame rate, Hz. */ rate_hz: number;
  /** False: frames are counted at 1 Hz. */ rate_known: boolean;
  /** Time of frame 0, s: frame i is at `first_time_s + i / rate_hz`. */ first_time_s: number;
  /** What the file calls frame 0. */ first_frame: number;
  /** Version of the program. */ version: string;
  /** The command as given. */ command_line: string;
  /** What stands out, folded by kind. */ groups: FindingGroup[];
  /** One per marker. */ markers: RecordedMarker[];
  /** Channels. */ channel_count: number;
  /** The first 2,000 of them. */ channels: Channel[];
  /** Events. */ event_count: number;
  /** The first 2,000 of them. */ events: RecordedEvent[];
  /** Cycles of each foot; null: no foot strikes twice. */ cycles: CycleSpans | null;
  /** Files read. */ inputs: InputFile[];
}

/** A marker of the recording. */
export interface RecordedMarker {
  /** Its name. */ name: string;
  /** True: somebody named it. */ labelled: boolean;
  /** Samples by state. */ states: StateCounts;
  /** Gaps. */ gaps: number;
  /** The longest, s; null: none. */ longest_gap_s: number | null;
  /** When it begins, s; null: none. */ longest_gap_time_s: number | null;
}

/** A channel beside the markers. */
export interface Channel {
  /** Its name. */ name: string;
  /** `angle`, `moment`, ..., `analog`. */ kind: string;
  /** Of the file. */ unit: string;
  /** Samples a second. */ rate_hz: number | null;
}

/** An event of the file. */
export interface RecordedEvent {
  /** `Foot Strike`, ... */ label: string;
  /** `Left`, `Right`, `General`, ... */ context: string;
  /** When, s. */ time_s: number;
}

/** Edits, or one sentence why the recording cannot be edited. */
export type Editing = EditingState | EditingRefused;

/** No edits. */
export interface EditingRefused {
  /** Why not. */ refused: string;
}

/** What is in the journal, and what it makes of the recording. */
export interface EditingState {
  /** Name of its file. */ journal: string;
  /** Digest of the edits in force. */ digest: string;
  /** In the order in which they were made. */ edits: JournalEntry[];
  /** Named spans of frames. */ regions: Region[];
  /** How many operations can be taken back. */ undo: number;
  /** How many can be brought back. */ redo: number;
  /** One sentence each. */ warnings: string[];
  /** How markers differ from other states of the recording. */ changes: Changes;
}

/** An operation of the journal; docs/formats/edits.md describes the members that each operation has besides. */
export interface JournalEntry {
  /** Its number. */ id: string;
  /** Its kind. */ do: string;
  /** The same in words. */ words: string;
  /** When, UTC. */ made?: string;
  /** By whom. */ author?: string;
  /** False: taken back. Absent of undo and redo. */ in_force?: boolean;
}

/** A named span. */
export interface Region {
  /** Its name. */ name: string;
  /** First frame. */ first: number;
  /** Last frame, included. */ last: number;
}

/** What edits changed. */
export interface Changes {
  /** By the last operation. */ last: MarkerChange[];
  /** By all of them. */ all: MarkerChange[];
}

/** How a marker differs from another state of the recording. */
export interface MarkerChange {
  /** Its name. */ marker: string;
  /** Frames with another position. */ moved: number;
  /** Frames that it is in now. */ came: number;
  /** Frames that it was in before. */ went: number;
  /** Frames with another state alone. */ restated: number;
  /** Largest move, mm. */ largest_mm: number;
  /** First frame that differs. */ first: number;
  /** Last frame that differs. */ last: number;
}

/** The page. */
export interface LivePage {
  /** What is known before the first frame. */ summary: LiveSummary;
}

/** A source. */
export interface LiveSummary {
  /** Which page this is. */ schema: "kinemark.live";
  /** Its version. */ schema_version: 1;
  /** Name for people. */ trial: string;
  /** As given. */ source: string;
  /** Version of the program. */ version: string;
  /** File that keeps the frames; null: none. */ recording: string | null;
  /** Nominal, Hz. */ rate_hz: number;
  /** Names in the order in which they come. */ markers: string[];
  /** Axis that points up, length 1. */ up: Vec;
  /** Who says so; empty: nobody. */ up_from: string;
  /** Smallest and largest coordinates, m; null: not known. */ extent_m: [Vec, Vec] | null;
  /** Of the model; none without one. */ coordinates: LiveCoordinate[];
  /** Bodies of the model, those that carry others first; none without one. */ bodies: LiveBody[];
  /** Markers of the model that follow markers of the source; none without a model. */ targets: LiveTarget[];
  /** Markers of each level, in words. */ levels: string[];
  /** Levels are priorities, the highest first; else weights. */ strict: boolean;
}

/** A body of the model. */
export interface LiveBody {
  /** Its name. */ name: string;
  /** Body that carries it, from 0; -1: the ground. */ parent: number;
  /** Mass, kg. */ mass_kg: number;
  /** Mass centre in the body, m. */ com_m: Vec;
}

/** A marker of the model that follows one of the source. */
export interface LiveTarget {
  /** Marker of the source, from 0. */ marker: number;
  /** Body that carries it, from 0. */ body: number;
  /** Where it is in the body, m. */ point_m: Vec;
  /** Level of its goal, from 0. */ level: number;
}

/** A coordinate of the model. */
export interface LiveCoordinate {
  /** Its name. */ name: string;
  /** Unit in the messages. */ unit: "deg" | "mm";
}

/** The page. */
export interface DeskPage {
  /** What is known before anything is asked. */ summary: DeskSummary;
}

/** A device, and where its trials go. */
export interface DeskSummary {
  /** Which page this is. */ schema: "kinemark.desk";
  /** Its version. */ schema_version: 1;
  /** Name for people. */ trial: string;
  /** Address of the device as given. */ source: string;
  /** Version of the program. */ version: string;
  /** Folder of the trials. */ folder: string;
}

/** How an acquisition stands, `/api/desk`. */
export interface DeskState {
  /** What is shown: the sources, the set-up of one, what it sees, a trial as it is recorded, its check. */ step: "source" | "plan" | "live" | "recording" | "check" | "ended";
  /** What went wrong or was done last, a sentence; may be empty. */ message: string;
  /** Sources that were found. */ sources: DeskSource[];
  /** The one that is open; null: none. */ device: DeskDevice | null;
  /** The set-up as typed. */ wanted: DeskWanted;
  /** The set-up as the device runs; null: it does not. */ granted: DeskGranted | null;
  /** Length of a trial, s; 0: until it is stopped. */ duration_s: number;
  /** What it sees; null: it does not run. */ live: DeskLive | null;
  /** What to know of the last trial. */ check: DeskCheckLine[];
  /** Files of the trials that were kept. */ kept: string[];
}

/** A source. */
export interface DeskSource {
  /** Its address. */ uri: string;
  /** Name for people. */ name: string;
  /** Why it cannot be opened; empty: it can. */ state: string;
}

/** What a device can do. */
export interface DeskDevice {
  /** What it calls itself. */ name: string;
  /** LEDs that it can light in turn; 0: none, they run by themselves. */ most_leds: number;
  /** Cameras, with four electrodes each. */ cameras: number;
  /** Bits of its converter. */ bits: number;
  /** It can set the light of each LED. */ sets_intensity: boolean;
  /** Shortest time of an LED, us. */ slot_us: number;
  /** Frames in a second at most, of 1, 2, ... 64 LEDs. */ highest_rates_hz: number[];
}

/** A set-up as typed. */
export interface DeskWanted {
  /** Address; empty: none. */ source: string;
  /** How many LEDs, or their names with commas. */ leds: string;
  /** Frames in a second; empty: as many as the LEDs leave room for. */ rate_hz: string;
  /** Length of a trial, s; empty: until it is stopped. */ duration_s: string;
  /** Who is measured; may be empty. */ subject: string;
  /** Name of the next trial. */ trial: string;
}

/** A set-up as it runs. */
export interface DeskGranted {
  /** Names, in the order in which they are lit. */ leds: string[];
  /** Names. */ cameras: string[];
  /** Frames in a second. */ rate_hz: number;
  /** Light of each LED, of its full light, above 0 and at most 1. */ intensity: number[];
}

/** What a device sees. */
export interface DeskLive {
  /** Frames that came since it was started. */ frames: number;
  /** Frames of the trial that are kept. */ acknowledged: number;
  /** Frames of the trial that the device lost. */ dropped_by_device: number;
  /** Frames of the trial that the program lost. */ dropped_here: number;
  /** Length of the trial so far, s. */ recorded_s: number;
  /** How to align the cameras; empty: nothing is known. */ guide: string;
  /** Of each LED, of each camera; of none before the first frames. */ seen: DeskSeen[][];
}

/** An LED as a camera saw it in the last second; null: it did not. */
export interface DeskSeen {
  /** Mean sum of the four channels above the dark slot, counts. */ light_counts: number | null;
  /** Brightest channel, of the highest code; near 1 it will clip. */ highest_share: number | null;
  /** Standard deviation of a channel from frame to frame without movement, counts. */ noise_counts: number | null;
  /** Share of the frames in which it was hidden. */ occluded_share: number;
  /** Share of the frames in which a channel clipped. */ saturated_share: number;
  /** Where it was on the detector, x right and y down in [-1, 1], the newest first. */ spots: ([number, number])[];
}

/** A line of the check of a trial. */
export interface DeskCheckLine {
  /** Nothing is to be done. */ good: boolean;
  /** A sentence; else with what to do. */ text: string;
}

/** The list of trials. */
export interface TrialsPage {
  /** Which page this is. */ summary: TrialsSummary;
  /** As `api/trials` answers it. */ list: Trials;
}

/** A list. */
export interface TrialsSummary {
  /** Which page this is. */ schema: "kinemark.trials";
  /** Its version. */ schema_version: 1;
  /** Version of the program. */ version: string;
  /** Where the server's pages begin: `/SESSION/`. */ root: string;
}

/** What there is. */
export interface Trials {
  /** In the order of the list. */ trials: TrialRow[];
  /** Sentences above the list. */ notes: string[];
}

/** A trial, as far as the server is with it: all that is not known is null. */
export interface TrialRow {
  /** Its number, for as long as the server runs. */ number: number;
  /** Of its file. */ name: string;
  /** That its file is in. */ folder: string;
  /** Its page, below the root. */ page: string;
  /** How far the server is. */ state: "reading" | "read" | "unreadable";
  /** What it is: `markers`, `cleaned markers`, `solved trial`, `table`. */ kind: string | null;
  /** Markers; of a solved trial those used. */ markers: number | null;
  /** Frames. */ frames: number | null;
  /** Frame rate, Hz; null also where the file states none. */ rate_hz: number | null;
  /** Frames by rate, s. */ duration_s: number | null;
  /** Share of marker frames that cameras measured, 0 to 1. */ measured: number | null;
  /** Of its report; null: nobody judged it. */ verdict: Verdict | null;
  /** Why it cannot be read, or what is odd, in a sentence. */ said: string | null;
}

/** What a file holds that has no report, as `kinemark info` knows it. */
export interface FactsPage {
  /** Which page this is. */ summary: FactsSummary;
  /** What is odd, a sentence each. */ warnings: string[];
  /** In the order of `info`. */ facts: Fact[];
  /** What there are several of; none is empty. */ lists: FactList[];
}

/** A file. */
export interface FactsSummary {
  /** Which page this is. */ schema: "kinemark.facts";
  /** Its version. */ schema_version: 1;
  /** Version of the program. */ version: string;
  /** Where the server's pages begin: `/SESSION/`. */ root: string;
  /** Name of the file. */ trial: string;
  /** What it is. */ kind: string;
}

/** Something that the file says of itself. */
export interface Fact {
  /** With its unit: `rate, Hz`. */ name: string;
  /** In words. */ value: string;
}

/** Something that the file has several of. */
export interface FactList {
  /** What they are. */ name: string;
  /** Each in words. */ values: string[];
}

/** What is wrong, in place of a page. */
export interface NoticePage {
  /** Which page this is. */ summary: NoticeSummary;
  /** What is wrong and what can be done. */ sentence: string;
}

/** Something that is wrong. */
export interface NoticeSummary {
  /** Which page this is. */ schema: "kinemark.notice";
  /** Its version. */ schema_version: 1;
  /** Version of the program. */ version: string;
  /** Where the server's pages begin: `/SESSION/`. */ root: string;
  /** Its heading: the name of a file, or what is wrong in two words. */ trial: string;
}

/** Envelope of the page. */
export interface ResultSummary {
  /** Which page this is. */ schema: "kinemark.result_report";
  /** Its version. */ schema_version: 1;
  /** Which result it shows. */ kind: "joints" | "scale" | "calibrate" | "reconstruct" | "study" | "measures" | "gait";
  /** Name for people. */ trial: string;
  /** `attention`: look before use. */ verdict: Verdict;
  /** Version of the program. */ version: string;
  /** The command as given; empty for a study. */ command_line: string;
  /** What stands out, folded by kind. */ groups: FindingGroup[];
  /** Files read. */ inputs: InputFile[];
  /** Frames of the scene; null: no scene. */ clock: Clock | null;
}

/** One of these, by `summary.kind`. */
export type ResultPage = JointsPage | ScalePage | CalibratePage | ReconstructPage | StudyPage | MeasuresPage | GaitPage;

/** The page of joints. */
export interface JointsPage {
  /** Envelope. */ summary: ResultSummary & { kind: "joints" };
  /** The document of the command, and what the page adds. */ result: JointsResult;
  /** Space. */ scene: PackedScene;
}

/** The page of scale. */
export interface ScalePage {
  /** Envelope. */ summary: ResultSummary & { kind: "scale" };
  /** The document of the command, and what the page adds. */ result: ScaleResult;
  /** No space view. */ scene: null;
}

/** The page of calibrate. */
export interface CalibratePage {
  /** Envelope. */ summary: ResultSummary & { kind: "calibrate" };
  /** The document of the command, and what the page adds. */ result: CalibrateResult;
  /** Space. */ scene: PackedScene;
}

/** The page of reconstruct. */
export interface ReconstructPage {
  /** Envelope. */ summary: ResultSummary & { kind: "reconstruct" };
  /** The document of the command, and what the page adds. */ result: ReconstructResult;
  /** Space. */ scene: PackedScene;
}

/** The page of study. */
export interface StudyPage {
  /** Envelope. */ summary: ResultSummary & { kind: "study" };
  /** The document of the command, and what the page adds. */ result: StudyResult;
  /** No space view. */ scene: null;
}

/** The page of measures. */
export interface MeasuresPage {
  /** Envelope. */ summary: ResultSummary & { kind: "measures" };
  /** The document of the command, and what the page adds. */ result: MeasuresResult;
  /** No space view. */ scene: null;
}

/** The page of a gait report. */
export interface GaitPage {
  /** Envelope. */ summary: ResultSummary & { kind: "gait" };
  /** What it shows. */ result: GaitResult;
  /** No space view. */ scene: null;
}

/** Segments, joints and lengths. */
export interface JointsResult {
  /** Digest that the files of one run share, 16 hexadecimal digits; in the file alone. */ kinemark_set?: string;
  /** Checksum of the file, 16 hexadecimal digits; in the file alone. */ kinemark_sum?: string;
  /** Which document this is. */ schema: "kinemark.skeleton";
  /** It counts up when a member changes its meaning. Version 1 counted frames from 0. */ schema_version: 2;
  /** Frames of the recording, F. */ frames: number;
  /** What the recording's file calls frame 0. */ first_frame: number;
  /** Frame rate, Hz. */ rate_hz: number;
  /** Marker noise along one axis. */ noise_sd_m: number | null;
  /** Markers that move together. */ segments: Segment[];
  /** Joints between them. */ joints: Joint[];
  /** Distances between joints of one segment. */ lengths: Length[];
  /** Doubts about the fit, one sentence each. */ warnings: string[];
  /** Version of the program. */ version: string;
  /** The command as given. */ command: string;
  /** The recording. */ input: JointsInput;
  /** As asked for. */ method: string;
  /** Remarks, one sentence each. */ notes: string[];
  /** Segments and joints that are no body's. */ left_out: LeftOut[];
  /** What to do first, in a sentence. */ next_step?: string;
  /** Markers that moved on their segment for good. */ slips: Slip[];
  /** Noise of each marker; absent where it was not found. */ marker_noise?: MarkerNoise[];
  /** Where segments come from, joints that are not determined, rivals: docs/stages/joints.md. */ segmentation?: object;
  /** How well the data fix segments and the joints between them: docs/stages/joints.md. */ topology?: object | null;
}

/** The recording. */
export interface JointsInput {
  /** As given. */ path: string;
  /** Digest of its bytes, hexadecimal. */ xxh3_64: string;
}

/** 3 x 3, row by row; null where not known. */
export type Matrix = [KnownVec, KnownVec, KnownVec];

/** Markers that move together. */
export interface Segment {
  /** Its name. */ name: string;
  /** What its markers span. */ kind: "line" | "plane" | "solid";
  /** Its markers. */ markers: PlacedMarker[];
}

/** A marker of a segment. */
export interface PlacedMarker {
  /** Its name. */ name: string;
  /** In the axes of the segment, m. */ x_in_segment_m: KnownVec;
}

/** A joint. Known in one segment alone, the other's members are null. */
export interface Joint {
  /** Its name. */ name: string;
  /** What it leaves free. */ kind: "ball" | "hinge";
  /** Segment. */ parent: string;
  /** Segment that moves in it. */ child: string;
  /** Method that found it; empty: not found. */ method: string;
  /** What the motion shows of it. */ words: string;
  /** Between the farthest postures, deg. */ range_of_motion_deg: number | null;
  /** In the axes of the parent. */ centre_in_parent_m: KnownVec | null;
  /** In the axes of the child. */ centre_in_child_m: KnownVec | null;
  /** Accuracy of the centre. */ covariance_in_parent_m2: Matrix | null;
  /** The same in the child. */ covariance_in_child_m2: Matrix | null;
  /** Covariance over other parts of the recording. */ repeatability_in_parent_m2: Matrix | null;
  /** The same in the child. */ repeatability_in_child_m2: Matrix | null;
  /** Of the axis, rad^2; of hinges alone, as all that begins with axis. */ axis_repeatability_in_parent?: Matrix | null;
  /** Direction, length 1. */ axis_in_parent?: KnownVec;
  /** Direction, length 1. */ axis_in_child?: KnownVec;
  /** Standard deviation of the direction, deg. */ axis_sd_deg?: number | null;
  /** Of the direction, rad^2. */ axis_covariance_in_parent?: Matrix;
  /** Root of the trace of the covariance, of a hinge across its axis. */ accuracy_sd_m: number | null;
  /** The same of the repeatability. */ repeatability_sd_m: number | null;
  /** Share of prior knowledge in the centre, 0 to 1. */ prior_share: number | null;
  /** What the centre rests on; null: not known. */ source: "recording" | "prior" | null;
  /** Markers that slide on their segment. */ skin: Skin;
  /** RMS over frames of the centre's standard deviation (root of the trace). */ centre_sd_m: number | null;
  /** The same without the direction known worst; of hinges alone. */ centre_sd_across_axis_m?: number | null;
  /** Frames by what is known of the centre. */ frames: CentreFrames;
}

/** Number of frames. */
export interface CentreFrames {
  /** One position fits, from the markers of the frame alone. */ determined: number;
  /** Found with neighbouring frames. */ bridged: number;
  /** Several positions fit equally well. */ ambiguous: number;
  /** No position. */ undetermined: number;
}

/** What the recording shows of markers that slide with the posture; numbers are null where not tested. */
export interface Skin {
  /** In one word. */ verdict: string;
  /** The same in a sentence. */ words: string;
  /** Movements of the joint. */ movements: number;
  /** Movements that agree. */ alike: number;
  /** Of the test. */ p_value: number | null;
  /** Share of the residual explained, 0 to 1. */ explained: number | null;
  /** Slide of a marker by itself, m/rad. */ own_slide_m_per_rad: number | null;
  /** What is too much, m/rad. */ own_slide_limit_m_per_rad: number | null;
  /** How far the joint opens with the posture. */ gap_with_posture_m: number | null;
}

/** A distance between two joints of a segment. */
export interface Length {
  /** Its name. */ name: string;
  /** Joint. */ from: string;
  /** Joint. */ to: string;
  /** The distance. */ length_m: number | null;
  /** Its standard deviation. */ sd_m: number | null;
}

/** A segment or a joint that no body has. */
export interface LeftOut {
  /** Which of the two. */ kind: "segment" | "joint";
  /** Its name. */ name: string;
  /** What was measured. */ figure: string;
  /** The figure. */ value_m: number | null;
  /** Least that a body has. */ least_m: number | null;
  /** Most that a body has. */ most_m: number | null;
  /** Markers of it. */ markers: string[];
  /** The same in a sentence. */ words: string;
}

/** A marker that moved on its segment. */
export interface Slip {
  /** In a sentence. */ words: string;
  /** How far. */ shift_m: number | null;
  /** Its standard deviation. */ sd_m: number | null;
  /** First frame after it. */ frame: number;
}

/** Noise of a marker. */
export interface MarkerNoise {
  /** Its name. */ name: string;
  /** Along one axis. */ sd_m: number;
}

/** A model made to fit a subject. */
export interface ScaleResult {
  /** Digest that the files of one run share, 16 hexadecimal digits; in the file alone. */ kinemark_set?: string;
  /** Checksum of the file, 16 hexadecimal digits; in the file alone. */ kinemark_sum?: string;
  /** Which document this is. */ format: "kinemark-scale";
  /** Its version. */ version: 1;
  /** Version of the program. */ program: string;
  /** The command as given. */ command: string;
  /** Name of the model. */ model: string;
  /** Mass of its bodies together, kg. */ mass_kg: number;
  /** Of the program. */ exit_status: number;
  /** Remarks, one sentence each. */ notes: string[];
  /** Joints of clavicles that were set free. */ clavicles: string[];
  /** Factors on x, y and z by body. */ factors: Record<string, Vec>;
  /** Joints placed by functional centres. */ joints: string[];
  /** Muscles and ligaments at rest. */ muscles: Muscle[];
  /** What the file held and the output does not. */ lost: string[];
  /** How static trials were judged: docs/stages/scale.md. */ static_trials?: object[];
  /** Sizes measured between markers. */ measurements?: Measurement[];
  /** Markers placed by the static trial. */ placed?: PlacedMarkers;
  /** Sizes fitted to the static trial. */ static?: Adapted;
  /** Sizes fitted to the motion. */ motion?: Adapted;
}

/** A path in the default pose. */
export interface Muscle {
  /** Its name. */ name: string;
  /** After over before. */ ratio: number | null;
  /** Length before, m. */ before_m: number;
  /** Length after, m. */ after_m: number;
  /** True: it wraps, and was measured straight. */ straight_for_wrapped: boolean;
}

/** A size. */
export interface Measurement {
  /** Its name. */ name: string;
  /** Of the body's size. */ factor: number;
  /** What it is the mean of. */ pairs: MeasuredPair[];
}

/** A distance between two markers. */
export interface MeasuredPair {
  /** Their names. */ markers: [string, string];
  /** In the recording, m. */ measured_m: number;
  /** Its standard deviation, m. */ measured_sd_m: number | null;
  /** In the model, m. */ model_m: number;
}

/** Markers in the static pose. */
export interface PlacedMarkers {
  /** RMS error before they were moved, m. */ rms_m: number;
  /** Markers of the model that it lacks. */ not_in_static_trial: string[];
  /** One per marker of the model. */ markers: PlacedOnBody[];
}

/** A marker of the model. */
export interface PlacedOnBody {
  /** Its name. */ name: string;
  /** Body that it is on. */ body: string;
  /** Position before, m. */ before_in_body_m: Vec;
  /** Position after, m. */ after_in_body_m: Vec;
  /** Distance from the measured marker before, m; null: not seen. */ error_m: number | null;
  /** True: kept in place. */ fixed: boolean;
}

/** A fit of sizes and positions. */
export interface Adapted {
  /** Frames used. */ frames: number;
  /** Steps. */ iterations: number;
  /** False: it stopped at its largest number of steps. */ converged: boolean;
  /** RMS marker error before, m. */ rms_before_m: number;
  /** RMS marker error after, m. */ rms_after_m: number;
  /** Marker noise along one axis, m. */ noise_sd_m: number;
  /** What follows the posture, along one axis, m; null: one posture cannot show it. */ soft_tissue_sd_m: number | null;
  /** Distances between joints of one segment. */ lengths: FittedLength[];
  /** Numbers fitted. */ parameters: Parameter[];
  /** What the data do not determine, one sentence each. */ not_determined: string[];
  /** What to record, one sentence each. */ recommendations: string[];
}

/** A distance between two joints. */
export interface FittedLength {
  /** Its name. */ name: string;
  /** Before, m. */ initial_m: number;
  /** After, m. */ length_m: number;
  /** Its standard deviation, m. */ sd_m: number | null;
  /** True: by the data. */ determined: boolean;
}

/** A number that was fitted. */
export interface Parameter {
  /** Its name. */ name: string;
  /** A factor, or a coordinate in m. */ kind: "size" | "joint place" | "marker place";
  /** Before. */ initial: number;
  /** After. */ value: number;
  /** Standard deviation; null: not known. */ sd: number | null;
  /** Standard deviation assumed before. */ prior_sd: number;
  /** True: by the data. */ determined: boolean;
}

/** A calibrated rig. */
export interface CalibrateResult {
  /** As asked for. */ method: string;
  /** 1 where the model explains the counts. As all of the fit, of the methods `bundle` and `scan` alone. */ chi2_per_dof?: number | null;
  /** Degree of the detector's warp. */ warp_degree?: number;
  /** True: terms between electrodes were fitted. */ crosstalk?: boolean;
  /** Steps. */ iterations?: number;
  /** Poses of the tree. */ poses?: number;
  /** LEDs seen by a camera in a pose. */ sightings?: number;
  /** Sightings left out. */ outliers?: number;
  /** RMS error of the tree's sides, triangulated without it. */ side_rms_mm?: number | null;
  /** The rig against its nominal poses. */ alignment?: Alignment;
  /** The rig's file, where one was found. */ written?: string;
  /** One sentence each. */ warnings: string[];
  /** One per camera. */ cameras: CalibratedCamera[];
}

/** How far cameras are from where they were meant to stand. */
export interface Alignment {
  /** One per camera. */ cameras: AlignedCamera[];
  /** True: within tolerance. */ aligned: boolean;
  /** What to turn or move next, in a sentence. */ next: string;
}

/** A camera against its nominal pose. */
export interface AlignedCamera {
  /** Its name. */ camera: string;
  /** Deviation of the lens. */ right_down_forward_mm: KnownVec;
  /** Its standard deviation; 0: the camera that fixes the frame. */ right_down_forward_sd_mm: KnownVec;
  /** Rotation still needed. */ tilt_pan_roll_deg: KnownVec;
  /** Its standard deviation. */ tilt_pan_roll_sd_deg: KnownVec;
}

/** A camera in the laboratory. */
export interface CalibratedCamera {
  /** Its name. */ name: string;
  /** The lens. */ centre_mm: KnownVec;
  /** Its standard deviation; null: not known. */ centre_sd_mm: KnownVec | null;
  /** Of rotations about x, y, z; null: not known. */ rotation_sd_deg: KnownVec | null;
}

/** Points from counts. */
export interface ReconstructResult {
  /** As asked for. */ method: string;
  /** Frames. */ frames: number;
  /** File of the points. */ written: string;
  /** One sentence each. */ warnings: string[];
  /** One per LED. */ leds: Led[];
  /** Light as each camera sees it, one per LED whose light is known; on pages alone. */ light_curves?: LightCurves[];
  /** Along y and along z; null: the method states no covariance. */ precision: (PrecisionMap | null)[];
}

/** What became of an LED. Its light is not there by the method `classic`; the last six are of the method `smoother` alone. */
export interface Led {
  /** Its name. */ name: string;
  /** Frames. */ frames: number;
  /** Frames with a point. */ located: number;
  /** Frames in which fewer than two cameras saw it. */ occluded: number;
  /** Frames in which cameras stood at their highest code. */ saturated: number;
  /** Frames in which cameras contradict each other. */ inconsistent: number;
  /** Frames located near a detector's edge. */ near_edge: number;
  /** Light relative to the LEDs of the calibration; null: not known, taken for 1. */ light?: number | null;
  /** Its standard deviation. */ light_sd?: number | null;
  /** What it stands on: `direction` (strengths, the LED keeps its direction), `turning` (strengths of an LED that turns), `stray` (the stray light alone), `unknown`. */ light_source?: string;
  /** Median of the counts that it makes, one per camera; 0: not seen. */ strength_counts?: (number | null)[];
  /** Integrations of the smoother. */ order?: number;
  /** Frequency of half gain, Hz. */ cutoff_hz?: number | null;
  /** 1 where noise explains the residuals. */ chi2_per_dof?: number | null;
  /** Counts left out. */ rejected?: number;
  /** Counts that weigh less than one half. */ held_down?: number;
  /** Amplitude of the room's light, counts, one per camera. */ flicker_counts?: (number | null)[];
}

/** Light of an LED over time: relative to the LEDs of the calibration, times the cosine of the LED's direction to the camera. */
export interface LightCurves {
  /** Its name. */ led: string;
  /** Names of the cameras. */ cameras: string[];
  /** Times of the samples. */ time_s: number[];
  /** Of each camera: a number a time; null: not looked at, or not seen. */ seen: ((number | null)[])[];
}

/** Median standard deviation of a point over a plane. */
export interface PrecisionMap {
  /** Which axes of the laboratory go across and up: 0 x, 1 y, 2 z. */ axes: [number, number];
  /** Lower corner, m. */ first_m: [number, number];
  /** Side of a cell, m. */ cell_m: number;
  /** Cells across. */ columns: number;
  /** Cells up. */ rows: number;
  /** rows x columns: root of the sum over the axes; null: no sample. */ sd_mm: (number | null)[];
  /** rows x columns: points in each cell. */ samples: number[];
}

/** Measures of movements. */
export interface MeasuresResult {
  /** What the page is of. */ heading: string;
  /** What its rows are of. */ rows: string;
  /** Subjects of the rows. */ markers: number;
  /** Spans measured. */ regions: number;
  /** Coverage of the intervals, 0 to 1. */ level: number;
  /** Simulated recordings behind each interval; 0: no intervals. */ refits: number;
  /** Largest share of samples that were not measured, 0 to 1. */ most_not_measured: number;
  /** One per value. */ measures: Measure[];
  /** Figures. */ figures: DrawnFigure[];
  /** Of the page alone: spikes, trials and field potentials on the recording's clock; absent: the file has none. */ neural?: NeuralLanes;
}

/** A value. Those that do not apply are absent. */
export interface Measure {
  /** Its identifier: `kinemark measure --list`. */ measure: string;
  /** Marker, foot, plate or channel. */ subject: string;
  /** Side or condition. */ context?: string;
  /** Span measured; absent: all of it. */ region?: string;
  /** Which cycle, from 0. */ cycle?: number;
  /** First time, s. */ start_s: number | null;
  /** Last time, s. */ end_s: number | null;
  /** In `unit`; null: not determined. */ value: number | null;
  /** Unit of value, interval, sd and uncorrected. */ unit: string;
  /** Where the truth lies. */ interval: Interval;
  /** Standard deviation; null: not known. */ sd: number | null;
  /** Before the bias of noise was taken away. */ uncorrected: number | null;
  /** Share of samples that were not measured, 0 to 1. */ share_not_measured: number | null;
  /** How the interval was found. */ method: string;
  /** What must be known, in a few words. */ remark?: string;
  /** Name for people; in the page alone, as `shown`. */ title: string;
  /** Value, interval and unit in words. */ shown: string;
}

/** Where the truth lies with the probability `level`. */
export interface Interval {
  /** Which ends are there. */ kind: "none" | "two-sided" | "at most" | "at least";
  /** Lower end; null: none. */ low: number | null;
  /** Upper end; null: none. */ high: number | null;
  /** 0 to 1. */ level: number;
  /** True: it covers less in some movements. */ approximate: boolean;
}

/** A founding paper beside ours. */
export interface StudyResult {
  /** Seeds of the recordings. */ seeds: number[];
  /** One per quantity. */ rows: StudyRow[];
  /** All bounds are met; null: none was set. */ pass: boolean | null;
  /** Name of the study. */ title: string;
  /** The paper in a sentence. */ description: string;
  /** What the second column is of. */ classic: string;
  /** What columns mean. */ columns: string;
  /** Figures. */ figures: DrawnFigure[];
}

/** A quantity. */
export interface StudyRow {
  /** Its name. */ quantity: string;
  /** Its unit; `1`: a number. */ unit: string;
  /** As published; null: not published. */ paper: number | null;
  /** By the paper's method; null: not compared. */ classic: number | null;
  /** By ours. */ ours: number | null;
  /** Right value or bound; null: none. */ expected: number | null;
  /** Which of the two, in words; null: none. */ expected_is: string | null;
  /** At most, or [at least, at most]; null: nothing was asked. */ bound: number | null | [number | null, number | null];
  /** Within the bound; null: nothing was asked. */ pass: boolean | null;
}

/** A gait report. */
export interface GaitResult {
  /** Left and right. */ feet: [GaitFoot, GaitFoot];
  /** Where the angles come from; null: none is drawn. */ angles_from: string | null;
  /** Lengths and speed are those on its belt. */ treadmill: boolean;
  /** Coverage of the intervals of measures, 0 to 1; null: there are none. */ level: number | null;
  /** Who the norms of measures are from. */ norm_sources: string[];
  /** The norms of curves in words; empty: none is drawn. */ curve_norm: string;
  /** The figures show what measurement alone does to a curve. */ own_error: boolean;
  /** Curves over the cycle, and pairs of angles. */ figures: DrawnFigure[];
  /** Measures of time and distance. */ measures: GaitMeasure[];
  /** How far the walk is from the norm. */ deviation: GaitScores;
  /** Ascending in time. */ events: GaitPageEvent[];
}

/** What the cycles of a foot have in common. */
export interface GaitFoot {
  /** From strike to strike. */ cycles: number;
  /** Cycles and toe-off in words. */ in_words: string;
}

/** One measure of left, right and both feet beside the norm, as shown. */
export interface GaitMeasure {
  /** Name for people. */ title: string;
  /** Span measured; empty: all of it. */ region: string;
  /** Unit of the values. */ unit: string;
  /** Left, right, both: value and interval; empty: not there. */ value: [string, string, string];
  /** `below`, `within` or `above` the norm, with what the interval says; empty: no norm. */ judgement: [string, string, string];
  /** The norm's range; empty: none. */ norm: string;
}

/** Movement Analysis Profile and Gait Profile Score (Baker et al. 2009). */
export interface GaitScores {
  /** The profile; empty: no norm has means. */ scores: GaitScore[];
  /** Gait Profile Score of left and right, deg; null: one of the nine is not known. */ side_deg: [number | null, number | null];
  /** Gait Profile Score of both sides, deg; null: one of the fifteen is not known. */ both_deg: number | null;
  /** Which of the nine are not known. */ lacking: string[];
}

/** Root mean square over the cycle of the mean curve less the norm's mean. */
export interface GaitScore {
  /** Name of the angle. */ title: string;
  /** Left and right, deg; null: not known at every point. */ value_deg: [number | null, number | null];
}

/** A strike or an off of a foot. */
export interface GaitPageEvent {
  /** Left or Right. */ foot: string;
  /** Foot Strike or Foot Off. */ event: string;
  /** When, s of the recording's clock. */ time_s: number;
  /** Standard deviation of that time, s; null: not known. */ sd_s: number | null;
  /** How it was found. */ by: string;
}

/** An answer with a status of 400 and above. */
export interface Refusal {
  /** Why, in a sentence. */ error: string;
  /** The edits as they are, where somebody else has edited meanwhile. */ editing?: EditingState;
}

/** How far the server is with the joint angles of a recording. */
export interface AnglesState {
  /** File of the body model; null: none is known, and `said` says why. */ model: string | null;
  /** What it does. */ state: "none" | "waiting" | "solving" | "solved" | "failed" | "stopped";
  /** Why it failed, in a sentence; null: nothing to say. */ said: string | null;
  /** Frames solved. */ done: number;
  /** Frames to solve. */ of: number;
  /** What was solved. */ solutions: Solutions;
}

/** Solutions of a recording; null: not solved. */
export interface Solutions {
  /** With the edits of now. */ now: SolutionFacts | null;
  /** With those of when it was solved before. */ before: SolutionFacts | null;
  /** Without any. */ recorded: SolutionFacts | null;
}

/** A solution. */
export interface SolutionFacts {
  /** Digest of the edits in force. */ digest: string;
  /** Edits in force. */ edits: number;
  /** The set that the files of the command would name. */ set: string;
  /** `attention`: look before use. */ verdict: Verdict;
  /** Findings of that level. */ attentions: number;
  /** RMS distance of measured and model marker, mm; null: not known. */ rms_mm: number | null;
}

/** What the space view draws, on P points. */
export interface PackedScene {
  /** Frames a point. */ frame_step: number;
  /** P. */ points: number;
  /** Axis of the laboratory that points up, length 1; null: the page finds it. */ up: Vec | null;
  /** Who says so: `the force plates`; empty: nobody. */ up_from: string;
  /** M markers. */ names: string[];
  /** The markers. */ markers: PackedMarkers;
  /** 3 M series: where the model has the markers; null: no model. */ model_m: PackedSeries | null;
  /** The same markers as they came in; null: nothing is compared. */ before: PackedMarkers | null;
  /** M x P packed bytes: worst state among the frames of a point; null with `frame_step` 1. */ worst: string | null;
  /** Force plates. */ plates: Plate[];
  /** Forces on the body. */ forces: PackedForce[];
  /** Bodies of the model, where it is known. */ bodies?: PackedBodies;
  /** Joint centres, where there are any. */ skeleton?: PackedJoints;
  /** Cameras, where there are any. */ cameras?: PackedCamera[];
}

/** M markers on P points. */
export interface PackedMarkers {
  /** 3 M series: marker by marker, x, y, z. */ positions_m: PackedSeries;
  /** M x P packed bytes: 0 measured, 1 upsampled, 2 interpolated, 3 model_filled, 4 missing, 5 rejected. */ states: string;
}

/** A force plate. */
export interface Plate {
  /** Type of the plate as C3D counts them. */ type: number;
  /** 4 corners x 3; null where the file has no number. */ corners_m: KnownVec[];
}

/** A force on the body; 0 where nothing was measured. */
export interface PackedForce {
  /** Plate or column it comes from. */ name: string;
  /** 3 series: x, y, z, N. */ force_n: PackedSeries;
  /** 3 series: where it acts. */ point_m: PackedSeries;
}

/** B bodies, each drawn as its mesh, or as a plain shape of its mass about the line from its origin to its end. */
export interface PackedBodies {
  /** B. */ names: string[];
  /** B. */ mass_kg: (number | null)[];
  /** 3 B series. */ origin_m: PackedSeries;
  /** 3 B series: where the next body begins; absent where a mesh is drawn. */ end_m: PackedSeries;
  /** Meshes, where there are any. */ meshes?: PackedMeshes;
  /** Which meshes are drawn and which are not, in one sentence. */ meshes_note?: string;
}

/** Meshes of N bodies. */
export interface PackedMeshes {
  /** N: which of the bodies. */ body: number[];
  /** N: points of each. */ points: number[];
  /** N: triangles of each. */ triangles: number[];
  /** 3 series: x, y and z of all points in the axes of their bodies. */ positions_m: PackedSeries;
  /** Packed bytes: words of 16 bits, three a triangle, counted within a body; each less the one before it, lower bytes of all, then upper ones. */ corners: string;
  /** 4 N series: unit quaternions w, x, y, z that turn the axes of the body into those of the laboratory, to 0.0005. */ turn: PackedSeries;
}

/** J joint centres. */
export interface PackedJoints {
  /** J. */ names: string[];
  /** Pairs of joints of one segment. */ links: ([number, number])[];
  /** 3 J series. */ centres_m: PackedSeries;
  /** 6 J series: lower triangular roots of the covariances, row by row; 0 unknown. */ roots_mm: PackedSeries;
  /** J x P packed bytes: 0 undetermined, 1 ambiguous, 2 bridged, 3 determined. */ states: string;
}

/** A camera; the axes have length 1. */
export interface PackedCamera {
  /** Its name. */ name: string;
  /** The lens. */ centre_m: Vec;
  /** To the right in its image. */ right: Vec;
  /** Down in its image. */ down: Vec;
  /** Along its optical axis. */ forward: Vec;
  /** Slopes of the edges of the view, across and down. */ half_view: [number, number];
  /** True: where it was meant to stand. */ nominal: boolean;
}

/** `attention` where at least one finding has that level. */
export type Verdict = "good" | "attention";

/** x, y and z in the axes that the member names. */
export type Vec = [number, number, number];

/** x, y and z; null where not known. */
export type KnownVec = [number | null, number | null, number | null];

/** Something to look at, in one sentence. */
export interface Finding {
  /** A problem, or a remark. */ level: "attention" | "note";
  /** Kind of thing: `gate`, `frames`, `coordinate`, `marker`, `gap`, `joint`, `measure`, `warning`, ... */ about: string;
  /** Name of the marker, coordinate or joint; may be empty. */ subject: string;
  /** One sentence. */ text: string;
  /** Where to look first, s; null: nowhere in particular. */ time_s: number | null;
}

/** Findings of one kind, folded into a line. */
export interface FindingGroup {
  /** Level of all of them. */ level: "attention" | "note";
  /** Number and kind: `2 markers partly missing`. */ title: string;
  /** The findings; the first 2,000. */ items: Finding[];
}

/** A quality check of the command. */
export interface Gate {
  /** Name of the check. */ name: string;
  /** False: exit status 1. */ passed: boolean;
  /** What was measured, in `unit`. */ value: number | null;
  /** What was asked, in `unit`. */ bound: number | null;
  /** Unit of both. */ unit: string;
  /** The same in words. */ sentence: string;
}

/** A file that the command read. */
export interface InputFile {
  /** `markers`, `model`, ... */ role: string;
  /** As given. */ path: string;
  /** Size. */ bytes: number;
  /** Digest of its bytes, hexadecimal. */ hash: string;
  /** Kind of digest. */ hash_kind: string;
}

/** Frame i of F is at `first_time_s + i / rate_hz`, and `first_frame + i` in the recording's file. */
export interface Clock {
  /** F. */ frames: number;
  /** Frame rate, Hz. */ rate_hz: number;
  /** Time of frame 0, s. */ first_time_s: number;
  /** What the recording's file calls frame 0. */ first_frame: number;
}

/** Samples by where they come from; frames of a marker. */
export interface StateCounts {
  /** No coordinates. */ missing: number;
  /** As recorded. */ measured: number;
  /** From the marker's own path. */ interpolated: number;
  /** From other markers. */ model_filled: number;
  /** Made by the recorder between two that it measured. */ upsampled: number;
  /** Left out as false. */ rejected: number;
}

/** A figure that the command drew. */
export interface DrawnFigure {
  /** Name for a file; absent of studies. */ name?: string;
  /** Words above the drawing. */ caption: string;
  /** SVG, and of studies HTML below it. The page takes drawing and text from it, no script. */ body: string;
}

/** One number a point, rounded to a step. */
export interface PackedCurve {
  /** How it is packed. */ kind: "rounded";
  /** What the numbers are multiples of: 1, 2 or 5 times a power of ten, in the unit of the curve. */ step: number;
  /** Words as they are, their differences, or the differences of those. */ order: 0 | 1 | 2;
  /** Bytes a word, B. */ bytes: number;
  /** True: a byte a point follows, 1 where the number is missing. */ absent: boolean;
  /** Base64 of a zlib stream. */ data: string;
}

/** A byte a point. */
export interface PackedCodes {
  /** How they are packed. */ kind: "codes";
  /** Base64 of a zlib stream. */ data: string;
}

/** In place of a curve that is the sum of two others: what came in is position and change together. */
export interface Sum {
  /** No numbers follow. */ kind: "sum";
}

/** x, y and z of a quantity; null where the result has no such number. */
export type EncodedAxes = [PackedCurve | null, PackedCurve | null, PackedCurve | null];

/** A curve and its standard deviation. */
export interface CurveWithSd {
  /** Missing where there is none. */ value: PackedCurve;
  /** One standard deviation, rounded up, in the same unit; null: not known. */ sd: PackedCurve | null;
}

/** Whose strikes bound a cycle. */
export type Foot = "Left" | "Right";

/** Coordinates over the cycles between two strikes of a foot. */
export interface EncodedCycles {
  /** Points of a cycle, P: 0 to 100 %. */ points: number;
  /** One per coordinate and foot. */ curves: CycleCurves[];
}

/** Cycles of one coordinate and one foot, deg or m. */
export interface CycleCurves {
  /** Its name. */ coordinate: string;
  /** Foot whose strikes bound the cycles. */ side: Foot;
  /** Cycles of which the mean is. */ count: number;
  /** Cycles that have a value everywhere. */ whole: number;
  /** Cycles with a value, at the point where fewest have one. */ fewest: number;
  /** The same where most have one. */ most: number;
  /** Cycles in `each`, D: 20 at most. */ drawn: number;
  /** D x P, cycle after cycle. */ each: PackedCurve;
  /** P, over all cycles. */ mean: PackedCurve;
  /** P, between all cycles (N - 1); null: fewer than two have a value anywhere. */ sd: PackedCurve | null;
}

/** Cycles by foot. */
export interface CycleSpans {
  /** [strike, next strike] of each cycle, s. */ Left: CycleSpan[];
  /** The same of the right foot. */ Right: CycleSpan[];
}

/** Strike and next strike of a foot, s. */
export type CycleSpan = [number, number];

/** N series of P points. A number that is absent repeats the one before it; states say where. */
export interface PackedSeries {
  /** Words of 16 bits in steps, or float32 as it is. */ kind: "int16" | "float32";
  /** N. */ series: number;
  /** P. */ points: number;
  /** N: number of word 0; of `int16` alone. */ offset?: number[];
  /** N: number a word; of `int16` alone. */ step?: number[];
  /** Base64 of a zlib stream. */ data: string;
}
