// What can be wrong with a report, in one sentence that the page shows.

/** An error whose message is meant for the reader of the page. */
export class ReportError extends Error {}

/** The sentence for any error. */
export function sentence_of(error) {
  if (error instanceof ReportError) return error.message;
  return `The page failed: ${error?.message ?? error}. Please report this with the file.`;
}
