// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

/** Names of programs that draw WebGL without a graphics card. */
const programs = /swiftshader|llvmpipe|softpipe|software|basic render/i;

let known: boolean | null = null;

/** Whether the processor draws, as it does where there is no graphics card. Asked of the browser once. */
export function isDrawnByProcessor(): boolean {
  if (known !== null) return known;
  const context = document.createElement("canvas").getContext("webgl2", { antialias: false, depth: false });
  const names = context?.getExtension("WEBGL_debug_renderer_info");
  known = names ? namesProgram(String(context!.getParameter(names.UNMASKED_RENDERER_WEBGL))) : false;
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return known;
}

/** Whether what a browser calls its renderer is a program. */
export const namesProgram = (renderer: string): boolean => programs.test(renderer);
