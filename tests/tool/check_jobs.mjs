// Jobs of Kubernetes by the schemas of its API, from npm's kubernetes-models (found through NODE_PATH).
// usage: check_jobs.mjs FILE.yaml
// Each document must be a Job that the schema takes, without a field that the schema does not have: a validator looks at
// the fields that it knows, and those that it never looked at are named. What the engine and the tool must agree on is
// held together too. Exit status: 1 where something is wrong, 77 where the packages are not installed.
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';

let yaml, Job;
try {
    yaml = createRequire(import.meta.url)('js-yaml');
    // An ES module, which NODE_PATH does not find.
    ({Job} = await import(`${process.env.NODE_PATH}/kubernetes-models/batch/v1/index.js`));
} catch {
    console.log('skipped: npm packages kubernetes-models and js-yaml are not installed');
    process.exit(77);
}

const failures = [];
function expect(condition, what) {
    if (!condition)
        failures.push(what);
}

// The same data; `seen` gets the path of each field that somebody reads, also of all that are listed.
function watch(data, path, seen) {
    if (data === null || typeof data !== 'object')
        return data;
    const see = key => seen.add(`${path}.${String(key)}`);
    return new Proxy(data, {
        get(target, key) {
            see(key);
            return watch(target[key], `${path}.${String(key)}`, seen);
        },
    });
}
function* fieldsOf(data, path) {
    if (data === null || typeof data !== 'object')
        return;
    for (const key of Object.keys(data)) {
        yield `${path}.${key}`;
        yield* fieldsOf(data[key], `${path}.${key}`);
    }
}
function unknownFields(job) {
    const seen = new Set();
    const watched = Object.create(Job.prototype, Object.fromEntries(Object.keys(job).map(
        key => [key, {enumerable: true, value: watch(job[key], `.${key}`, seen)}])));
    watched.validate();
    return [...fieldsOf(job.spec, '.spec')].filter(path => !seen.has(path));
}

function check(job) {
    expect(job.apiVersion === 'batch/v1' && job.kind === 'Job', `${job.kind} of ${job.apiVersion} is no Job`);
    try {
        new Job(job).validate();
        const unknown = unknownFields(job);
        expect(unknown.length === 0, `${job.metadata.name}: the schema has no ${unknown.join(', ')}`);
    } catch (error) {
        failures.push(`${job.metadata.name}: ${error.message}`);
    }
}

// The checks themselves: what is wrong on purpose must be told.
function expectRefused(job, change, what) {
    const before = failures.length, wrong = structuredClone(job);
    change(wrong);
    check(wrong);
    const told = failures.splice(before).length > 0;
    expect(told, `a Job with ${what} is not told`);
}

const jobs = yaml.loadAll(readFileSync(process.argv[2], 'utf8'));
jobs.forEach(check);
const [schedule, tiles, merge] = jobs;
expectRefused(tiles, job => { job.spec.backoffLimitPerIndexes = 3; }, 'a field that is not there');
expectRefused(tiles, job => { job.spec.template.spec.containers[0].resources.request = {}; }, 'a field misspelt within');
expectRefused(tiles, job => { job.spec.completions = 'all'; }, 'a count that is no number');

const command = tiles.spec.template.spec.containers[0].command;
expect(tiles.spec.completionMode === 'Indexed', 'the Job of tiles is not indexed');
expect(command.includes('--shard=auto') && command.includes('--resume'), 'a pod draws no shard, or cannot be tried again');
expect(command.includes(`--shards=${tiles.spec.completions}`), '--shards is not the number of completions');
expect(tiles.spec.suspend === true, 'the shards do not wait for the schedule');
const first = schedule.spec.template.spec.containers[0].command, own = /^--(shard|shards|threads|memory|resume)\b/;
expect(first.includes('--dry-run') && first.includes('--force'), 'the first Job is no dry run, or cannot be tried again');
expect(first.filter(word => word !== '--dry-run' && word !== '--force').join() === command.filter(word => !own.test(word)).join(),
       'the schedule is of another run than the shards');
expect(merge.spec.suspend === true, 'the merge does not wait');
expect(merge.spec.template.spec.containers[0].command[2].includes(`-of-${tiles.spec.completions}.pmtiles`),
       'the merge takes other parts');
for (const failure of failures)
    console.error(`${process.argv[2]}: ${failure}`);
console.log(`${jobs.length} Jobs, ${failures.length} failures`);
process.exit(failures.length ? 1 : 0);
