// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

type Pressed = Pick<KeyboardEvent, "key" | "ctrlKey" | "metaKey" | "altKey" | "shiftKey" | "target">;

/** What a key asks for: "undo", "redo", or the key itself; "" for what other programs take. */
export function keyOf({ key, ctrlKey, metaKey, altKey, shiftKey }: Pressed): string {
  if (altKey) return "";
  if (ctrlKey || metaKey) {
    const letter = key.toLowerCase();
    if (letter === "z") return shiftKey ? "redo" : "undo";
    return letter === "y" && !shiftKey ? "redo" : "";
  }
  return key;
}

/** Whether a key is meant for the page: nobody is typing or choosing with it. */
export function isOurs({ target }: Pressed): boolean {
  const { tagName, type } = (target ?? {}) as { tagName?: string; type?: string };
  if (tagName === "SELECT" || tagName === "TEXTAREA") return false;
  return tagName !== "INPUT" || type === "checkbox" || type === "range";
}
