// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { ResultPage } from "../page_types.ts";
import type { Content } from "./content.ts";
import { gaitPage } from "./gait.ts";
import { jointsPage } from "./joints.ts";
import { measuresPage } from "./measures.ts";
import { calibratePage, reconstructPage } from "./rig.ts";
import { scalePage } from "./scale.ts";
import { studyPage } from "./study.ts";

/** The page of a result whose numbers stand in the document of its command. */
export async function resultPage(data: ResultPage): Promise<Content> {
  const { schema, schema_version, kind } = data.summary;
  if (schema_version !== 1) throw new Error(`this page cannot read ${schema} version ${String(schema_version)}`);
  const pages = { joints: jointsPage, scale: scalePage, calibrate: calibratePage, reconstruct: reconstructPage, study: studyPage, measures: measuresPage, gait: gaitPage };
  if (!(kind in pages)) throw new Error(`this page knows no result of the kind ${kind}`);
  return pages[kind](data as never);
}
