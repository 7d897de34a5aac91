// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { ResultPageData } from "../result_types.ts";
import type { Content } from "./content.ts";
import { jointsPage } from "./joints.ts";
import { measuresPage } from "./measures.ts";
import { calibratePage, reconstructPage } from "./rig.ts";
import { scalePage } from "./scale.ts";
import { studyPage } from "./study.ts";

/** The page of a result whose numbers stand in the document of its command. */
export async function resultPage(data: ResultPageData): Promise<Content> {
  const { schema, schema_version, kind } = data.summary;
  if (schema_version !== 1) throw new Error(`this page cannot read ${schema} version ${schema_version}`);
  const pages: Record<string, (data: ResultPageData<never>) => Content | Promise<Content>> = {
    joints: jointsPage,
    scale: scalePage,
    calibrate: calibratePage,
    reconstruct: reconstructPage,
    study: studyPage,
    measures: measuresPage,
  };
  const page = pages[kind];
  if (page === undefined) throw new Error(`this page knows no result of the kind ${String(kind)}`);
  return page(data as ResultPageData<never>);
}
