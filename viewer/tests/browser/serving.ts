// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { execFileSync, spawn, type ChildProcess } from "node:child_process";
import { fileURLToPath } from "node:url";

/** The program: KINEMARK_PROGRAM, or what CI builds. */
export const program = process.env["KINEMARK_PROGRAM"] ?? fileURLToPath(new URL("../../../build/ci/bin/kinemark", import.meta.url));

/** Run the program and give what it prints. */
export const kinemark = (...words: string[]): string => execFileSync(program, words, { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] });

/** `kinemark serve` on a folder, ready to be asked. */
export interface Served {
  process: ChildProcess;
  /** "http://127.0.0.1:41873" */
  origin: string;
  /** With the token. */
  address: string;
}

export async function serve(folder: string, ...more: string[]): Promise<Served> {
  const child = spawn(program, ["serve", folder, "--no-open", ...more], { stdio: ["ignore", "pipe", "ignore"] });
  const address = await new Promise<string>((done, wrong) => {
    child.stdout.once("data", (line: Buffer) => done(String(line).trim()));
    child.once("exit", (status) => wrong(new Error(`kinemark serve ended with ${status}`)));
  });
  return { process: child, origin: new URL(address).origin, address };
}
