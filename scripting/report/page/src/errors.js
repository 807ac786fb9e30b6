// Errors of a report, as sentences that the page shows.

/** An error with a message for the user of the page. */
export class ReportError extends Error {}

/** Returns the sentence for an error. */
export function sentence_of(error) {
  if (error instanceof ReportError) return error.message;
  return `The page failed: ${error?.message ?? error}. Please report this with the file.`;
}
