-- For wrk: FILE once|again [ETAG]. Asks for the paths of a file, each thread for its share, one after the other. At its
-- end a thread stops, or begins again. When wrk ends it prints a line of JSON.
local ffi = require("ffi")
ffi.cdef("typedef struct { long s, ns; } moment; int clock_gettime(int clock, moment *now);")
local threads = {}

local function now()
    local read = ffi.new("moment")
    ffi.C.clock_gettime(1, read)
    return tonumber(read.s) + 1e-9 * tonumber(read.ns)
end
function setup(thread)
    thread:set("share", #threads)
    threads[#threads + 1] = thread
end
function init(arguments)
    requests, at, once = {}, 0, arguments[2] == "once"
    local line = 0
    for path in io.lines(arguments[1]) do
        if line % 2 == share then
            requests[#requests + 1] = wrk.format("GET", path, arguments[3] and {["If-None-Match"] = arguments[3]})
        end
        line = line + 1
    end
    begun = now()
end
function request()
    if once and at == #requests then
        ended = ended or now()
        wrk.thread:stop()
    end
    at = at % #requests + 1
    return requests[at]
end
function done(summary, latency)
    local e, first, last, all = summary.errors, math.huge, 0, true
    for _, thread in ipairs(threads) do
        all = all and thread:get("ended")
        first, last = math.min(first, thread:get("begun")), math.max(last, thread:get("ended") or 0)
    end
    io.write(string.format('{"requests": %d, "seconds": %.6f, "p50_ms": %.3f, "p99_ms": %.3f, "failed": %d}\n',
        summary.requests, all and last - first or summary.duration / 1e6, latency:percentile(50) / 1e3,
        latency:percentile(99) / 1e3, e.connect + e.read + e.write + e.status + e.timeout))
end
